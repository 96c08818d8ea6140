#include "gap/diagnosis/describe/offered_model.h"

#include <fmt/format.h>

namespace slipway::gap {
namespace {

// A model beside which something unknown is at work is still the better one to plan with, where no channel
// of drives held out is predicted worse by it than by the nominal one and one is predicted much better. Notes
// what was found.
bool predicts_nearer_or_notes_why_not(const HeldOutOptions& options, Diagnosis& d) {
  bool better = false;
  for (const ChannelClosure& c : d.gap) {
    if (c.retuned.value > options.no_worse * c.nominal.value) {
      d.notes.push_back(
          fmt::format("no corrected model is offered: on drives held out of the fit the re-tuned one would "
                      "predict {} {:.0f} % worse than the nominal one",
                      name_of(c.channel), 100.0 * (c.retuned.value / c.nominal.value - 1.0)));
      return false;
    }
    better = better || c.retuned.value < options.much_better * c.nominal.value;
  }
  if (better)
    d.notes.emplace_back(
        "the corrected model is the re-tuned one, without the effects named, and leaves something "
        "unexplained; it is offered because it predicted drives held out of the fit better than the "
        "nominal one");
  return better;
}

}  // namespace

void offer_model(const FittedExplanation& reported, double log_density_gain, const HeldOutOptions& options,
                 Diagnosis& d) {
  if (names_effects(d.verdict) && !(log_density_gain > 0.0)) {
    d.notes.push_back(
        "the correction did not improve drives held out of the fit: no corrected model is offered");
    return;
  }
  const bool offered = names_effects(d.verdict) || d.verdict == Verdict::kParameters ||
                       (d.verdict == Verdict::kUnknown && predicts_nearer_or_notes_why_not(options, d));
  if (!offered) return;
  d.model = reported.hypothesis.state(reported.x);
  d.model_effects = reported.hypothesis.settings(reported.x);
  d.left_open = posterior_of(reported);
}

}  // namespace slipway::gap
