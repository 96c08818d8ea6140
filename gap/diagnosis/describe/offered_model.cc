#include "gap/diagnosis/describe/offered_model.h"

#include <fmt/format.h>

#include <optional>
#include <string>

namespace slipway::gap {
namespace {

// The parameter that stands at one of the two ends of what it may be. An end at its neutral value is no end:
// there the parameter changes nothing.
std::optional<std::string> parameter_at_its_end(const FittedExplanation& fit) {
  for (std::size_t p = 0; p < fit.hypothesis.nuisance_count(); ++p) {
    const Parameter& parameter = fit.hypothesis.parameters()[p];
    const bool low = fit.x[p] <= parameter.lowest && parameter.lowest < parameter.neutral;
    const bool high = fit.x[p] >= parameter.highest && parameter.highest > parameter.neutral;
    if (low || high) return parameter.name;
  }
  return std::nullopt;
}

// Why the corrected model is no better one to plan with than the nominal one; nothing where it is.
std::optional<std::string> why_not_better(const FittedExplanation& reported, double log_density_gain,
                                          const HeldOutOptions& options, const Diagnosis& d) {
  const bool with_effects = names_effects(d.verdict);
  if (with_effects && !(log_density_gain > 0.0)) return "it did not improve drives held out of the fit";
  if (const auto end = parameter_at_its_end(reported))
    return fmt::format("{} would stand at the end of what it may be", *end);
  bool better = false;
  for (const ChannelClosure& c : d.gap) {
    const Interval& of_model = with_effects ? c.with_effects : c.retuned;
    const double corrected = of_model.value;
    // Beyond chance, or by as much as the noise.
    if (of_model.low > options.no_worse * c.nominal.value ||
        corrected > c.nominal.value + c.noise_floor.value)
      return fmt::format(
          "on drives held out of the fit it would predict {} {:.0f} % worse than the nominal one",
          name_of(c.channel), 100.0 * (corrected / c.nominal.value - 1.0));
    better = better || corrected < c.nominal.value;
  }
  if (!better) return "it predicts no channel of drives held out of the fit better than the nominal one";
  return std::nullopt;
}

}  // namespace

void offer_model(const FittedExplanation& reported, double log_density_gain, const HeldOutOptions& options,
                 Diagnosis& d) {
  if (d.verdict == Verdict::kNoGap || d.verdict == Verdict::kNotDetected ||
      d.verdict == Verdict::kInsufficient)
    return;
  if (const auto why = why_not_better(reported, log_density_gain, options, d)) {
    d.notes.push_back("no corrected model is offered: " + *why);
    return;
  }
  if (d.verdict == Verdict::kUnknown)
    d.notes.emplace_back("the corrected model is the re-tuned one and leaves something unexplained");
  d.model = reported.hypothesis.state(reported.x);
  d.model_effects = reported.hypothesis.settings(reported.x);
  d.left_open = posterior_of(reported);
}

}  // namespace slipway::gap
