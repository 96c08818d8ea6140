#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "gap/diagnosis/diagnosis.h"
#include "research/benchmark/location_score.h"

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

struct MarginalStatement : Statement {
  std::string effect;
  double closed_share = 0.0;
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
  bool wrong_name = false;                   // an effect is named that is not hidden
  std::vector<MarginalStatement> marginals;  // of every effect of the library: whether it is hidden
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
  // unknown: something is said to be unexplained, and no effect is named that is not hidden too.
  bool unknown = false, look_alike = false,
       absorbed = false;  // absorbed: nothing is said to be missing, or only what is hidden besides
  // Absorbed by parameters of which the diagnosis with the whole library says that these drives do not tell
  // them from the effect.
  bool declared = false;
  bool right() const { return unknown || look_alike || declared; }
};

// `open` is the diagnosis with the whole library; its confusable pairs define the look-alikes.
WithheldScore score_withheld(const HiddenAnswer& answer, const std::string& withheld, const Diagnosis& open,
                             const Diagnosis& diagnosis);

// Intersection over union of two discs.
double disc_overlap(const HiddenAnswer::Place& a, const HiddenAnswer::Place& b);

}  // namespace slipway::gap
