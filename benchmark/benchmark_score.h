#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "benchmark/location_score.h"
#include "gap/diagnosis/diagnosis.h"

namespace slipway::gap {

// The key of a campaign on which the diagnosis is judged: what was hidden in it.
struct HiddenAnswer {
  struct Place {
    double x_m = 0.0, y_m = 0.0, radius_m = 0.0;
  };
  std::string campaign;           // its folder's name
  std::set<std::string> effects;  // of the library or not; empty where nothing is missing
  // Whether soil and motors are off nominal; empty where the key does not state it.
  std::optional<bool> nominal_off;
  std::string fidelity, kind;  // "L2", "hills"; empty where the key does not state them
  double size = 1.0;           // of the effects, in units of their usual size
  std::optional<Place> place;  // of a soft patch
  // The wheel's number for effects of a single wheel; -1 is all wheels.
  std::map<std::string, double> wheel_of;
  std::vector<HiddenTrace> traces;  // where the effects act; empty where the key does not state it
};

struct Statement {
  double probability = 0.0;
  bool right = false;
};

enum class TruthKind { kNothing, kParameters, kEffects, kOutsideLibrary };

// The score of one diagnosis against its key.
struct CaseScore {
  std::string campaign, truth, verdict, found, fidelity, kind;
  double size = 1.0;
  TruthKind truth_kind = TruthKind::kNothing;
  bool exact = false;  // exactly the hidden set, under a verdict of its class
  // Exact, or a look-alike that the diagnosis declares as one: another effect, or re-tuned parameters alone.
  bool alike = false;
  bool verdict_right = false;    // the right class: no effect, effects, or unknown
  bool held = false;             // the truth is among the at most three sets that hold 0.95
  bool false_alarm = false;      // an effect or "unknown" where nothing is missing
  bool confident_wrong = false;  // a name that is not in the truth has more than 0.9
  bool partial = false;          // effects are named, and something unexplained beside them
  // Names of effects are exactly the hidden ones of the library, with or without something unexplained; none
  // of them is hidden where the cause is outside it.
  bool names_right = false;
  bool wrong_name = false;           // an effect is named that is not hidden
  std::vector<Statement> marginals;  // of every effect of the library: whether it is hidden
  double unknown_probability = 0.0;
  double stated = 0.0;              // the probability that the answer states for itself
  std::optional<bool> wheel_right;  // whether a found effect was found at the wheel where it was hidden
  std::optional<double> closed_fraction;
  // The share of the gap that a diagnosis closes to which the effects are given; empty where it was not run.
  std::optional<double> oracle_closed_fraction;
  std::optional<double> place_overlap;  // of the soft patch's disc, intersection over union
  // See location_score.h; empty unless the key has traces and effects of the library were hidden and named.
  std::optional<bool> channel_right;
  std::optional<double> slice_overlap, slice_attainable;
  double seconds = 0.0;
};

// `library` has the names of effects that a diagnosis can give.
CaseScore score_case(const HiddenAnswer& answer, const Diagnosis& diagnosis,
                     const std::set<std::string>& library, double seconds);

// A campaign diagnosed again with one of its effects withheld.
struct WithheldScore {
  std::string campaign, withheld, verdict, found, fidelity;
  bool unknown = false, look_alike = false,
       absorbed = false;  // absorbed: "parameters", "no_gap", "not_detected"
  // Absorbed by parameters of which the diagnosis with the whole library says that these drives do not tell
  // them from the effect.
  bool declared = false;
  bool right() const { return unknown || look_alike || declared; }
};

// `open` is the diagnosis with the whole library; its confusable pairs define the look-alikes.
WithheldScore score_withheld(const HiddenAnswer& answer, const std::string& withheld, const Diagnosis& open,
                             const Diagnosis& diagnosis);

// A share and its 90 % interval [Clopper & Pearson 1934].
struct Rate {
  std::size_t hits = 0, of = 0;
  double value() const { return of == 0 ? 0.0 : static_cast<double>(hits) / static_cast<double>(of); }
};
struct RateInterval {
  double low = 0.0, high = 1.0;
};
RateInterval binomial_interval(const Rate& rate, double confidence = 0.9);

// The probability that one of `of_these` is above one of `of_those`, with ties counting half; empty where
// either list is empty.
std::optional<double> area_under_roc(std::span<const double> of_these, std::span<const double> of_those);

// The mean distance of stated probability and frequency over ten bins of equal width, weighted by their
// counts.
std::optional<double> calibration_error(std::span<const Statement> statements);
std::optional<double> brier_score(std::span<const Statement> statements);

// A bin of a reliability curve: how probable its statements were on average, and how many were right.
struct ReliabilityBin {
  double from = 0.0, to = 0.0, mean_probability = 0.0;
  Rate right;
};
std::vector<ReliabilityBin> reliability_of(std::span<const Statement> statements);

// Intersection over union of two discs.
double disc_overlap(const HiddenAnswer::Place& a, const HiddenAnswer::Place& b);

// The figures of some of the cases.
struct BenchmarkFigures {
  Rate exact, alike, exact_sized,
      alike_sized;  // of campaigns with effects; "sized" are those of size 1 and above
  Rate held, verdict_right;
  Rate alarm_nothing, alarm_parameters;
  Rate unknown_reported;  // verdict "unknown" where the cause is outside the library
  Rate confident_wrong;
  // Of campaigns with effects: exactly, or partially with exactly the right names; of all campaigns: a name
  // that is not hidden; of causes outside the library alone: no effect of the library named.
  Rate names_right, wrong_name, outside_unnamed;
  Rate wheel_right;
  Rate overlap;  // soft patches whose disc overlaps by half or more
  Rate channel_right;
  Rate slice_half;  // of slices that were scored, those that overlap by half or more
  std::optional<double> slice_of_attainable;  // median of the overlaps over the attainable overlaps
  std::optional<double> unknown_auroc, calibration, brier, closed_fraction, place_overlap, slice_overlap,
      seconds;
  std::optional<double>
      closed_of_oracle;  // median share of what an oracle closes; 0 where no effect is named
  std::size_t cases = 0;
  std::vector<ReliabilityBin> reliability;  // of the marginal probabilities, by tenths; empty bins too
};
BenchmarkFigures figures_of(std::span<const CaseScore> cases);

// Counts by hidden and found causes.
using Confusion = std::map<std::string, std::map<std::string, int>>;
Confusion confusion_of(std::span<const CaseScore> cases);

}  // namespace slipway::gap
