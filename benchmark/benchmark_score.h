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

// What was hidden in a campaign that the diagnosis is judged on.
struct HiddenAnswer {
  struct Place {
    double x_m = 0.0, y_m = 0.0, radius_m = 0.0;
  };
  std::string campaign;           // its folder's name
  std::set<std::string> effects;  // of the library or not; empty: nothing is missing
  // Whether soil and motors are off nominal; nothing where the answers don't say.
  std::optional<bool> nominal_off;
  std::string fidelity, kind;  // "L2", "hills"; empty where the answers don't say
  double size = 1.0;           // of the effects, in their usual size
  std::optional<Place> place;  // of a soft patch
  // The wheel's number of effects that one wheel has (-1: all wheels).
  std::map<std::string, double> wheel_of;
  std::vector<HiddenTrace> traces;  // where it acts; empty where the answers don't say
};

enum class TruthKind { kNothing, kParameters, kEffects, kOutsideLibrary };

// One diagnosis against its answer.
struct CaseScore {
  std::string campaign, truth, verdict, found, fidelity, kind;
  double size = 1.0;
  TruthKind truth_kind = TruthKind::kNothing;
  bool exact = false;            // the very set, under a verdict of its class
  bool alike = false;            // or a look-alike of it, said to be one
  bool verdict_right = false;    // no effect, effects, unknown
  bool held = false;             // the truth is among the at most three sets that hold 0.95
  bool false_alarm = false;      // an effect or "unknown" where nothing is missing
  bool confident_wrong = false;  // a name that is not in the truth with more than 0.9
  double unknown_probability = 0.0;
  double stated = 0.0;              // the probability that the answer gives what it says
  std::optional<bool> wheel_right;  // of an effect that was found: at the wheel that it was hidden at
  std::optional<double> closed_fraction;
  // That a diagnosis closes which was told the effects; nothing where it was not asked.
  std::optional<double> oracle_closed_fraction;
  std::optional<double> place_overlap;  // of the soft patch's disc, intersection over union
  // Where the key says it and effects of the library were hidden and named: see location_score.h.
  std::optional<bool> channel_right;
  std::optional<double> slice_overlap, slice_attainable;
  double seconds = 0.0;
};

// `library`: names that a diagnosis can give.
CaseScore score_case(const HiddenAnswer& answer, const Diagnosis& diagnosis,
                     const std::set<std::string>& library, double seconds);

// A campaign diagnosed again with one of its effects withheld.
struct WithheldScore {
  std::string campaign, withheld, verdict, found, fidelity;
  bool unknown = false, look_alike = false,
       absorbed = false;  // absorbed: "parameters", "no_gap", "not_detected"
  bool right() const { return unknown || look_alike; }
};

// `open` is the diagnosis with the whole library: its confusable pairs say what is a look-alike.
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

// The chance that one of `of_these` is above one of `of_those`, ties counting half; nothing where either is
// empty.
std::optional<double> area_under_roc(std::span<const double> of_these, std::span<const double> of_those);

struct Statement {
  double probability = 0.0;
  bool right = false;
};
// Mean distance of stated probability and frequency over ten bins of equal width, weighed by their counts.
std::optional<double> calibration_error(std::span<const Statement> statements);
std::optional<double> brier_score(std::span<const Statement> statements);

// Intersection over union of two discs.
double disc_overlap(const HiddenAnswer::Place& a, const HiddenAnswer::Place& b);

// The figures of some of the cases.
struct BenchmarkFigures {
  Rate exact, alike, exact_sized, alike_sized;  // of campaigns with effects; sized: of size 1 and above
  Rate held, verdict_right;
  Rate alarm_nothing, alarm_parameters;
  Rate unknown_reported;  // verdict "unknown" where the cause is outside the library
  Rate confident_wrong;
  Rate wheel_right;
  Rate overlap;  // soft patches whose disc overlaps by half or more
  Rate channel_right;
  Rate slice_half;  // of slices that were scored, those that overlap by half or more
  std::optional<double> slice_of_attainable;  // median of each one's overlap over the most that there is
  std::optional<double> unknown_auroc, calibration, brier, closed_fraction, place_overlap, slice_overlap,
      seconds;
  std::optional<double>
      closed_of_oracle;  // median share of what an oracle closes; 0 where no effect is named
  std::size_t cases = 0;
};
BenchmarkFigures figures_of(std::span<const CaseScore> cases);

// What was hidden -> what was found -> how often.
using Confusion = std::map<std::string, std::map<std::string, int>>;
Confusion confusion_of(std::span<const CaseScore> cases);

}  // namespace slipway::gap
