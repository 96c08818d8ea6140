#include "gap/diagnosis/describe/found_causes.h"

#include <algorithm>
#include <cmath>

#include "gap/diagnosis/model/outside_cause.h"

namespace slipway::gap {
namespace {

// The parameters of one of a fit's causes: what was estimated, and what was held.
std::vector<FoundParameter> parameters_of(const FittedExplanation& fit, std::size_t which, bool with_held) {
  const EffectVariant& variant = fit.hypothesis.effects()[which];
  const auto parameters = fit.hypothesis.parameters();
  std::vector<FoundParameter> found;
  for (std::size_t p = fit.hypothesis.nuisance_count(); p < parameters.size(); ++p)
    if (parameters[p].effect == variant.effect)
      found.push_back({parameters[p].name.substr(variant.effect.size() + 1), parameter_interval(fit, p)});
  if (with_held)
    for (const auto& [field, value] : variant.fixed) found.push_back({field, {value, value, value}});
  return found;
}

}  // namespace

Interval parameter_interval(const FittedExplanation& fit, std::size_t parameter) {
  const auto i = static_cast<Eigen::Index>(parameter);
  const Parameter& p = fit.hypothesis.parameters()[parameter];
  Interval interval = normal_interval(fit.x[parameter], p.std * std::sqrt(fit.covariance(i, i)));
  interval.low = std::clamp(interval.low, std::min(p.lowest, interval.value), interval.value);
  interval.high = std::clamp(interval.high, interval.value, std::max(p.highest, interval.value));
  return interval;
}

std::vector<FoundEffect> found_effects(const FittedExplanation& fit, std::span<const std::string> names,
                                       std::span<const EffectMarginal> marginals) {
  std::vector<FoundEffect> all;
  const auto effects = fit.hypothesis.effects();
  for (std::size_t e = 0; e < effects.size(); ++e)
    if (std::find(names.begin(), names.end(), effects[e].effect) != names.end())
      all.push_back({effects[e].effect, effects[e].label,
                     marginal_of(marginals, effects[e].effect).probability, parameters_of(fit, e, true)});
  return all;
}

std::optional<OutsideFinding> outside_finding(const FittedExplanation& fit, const DriveCampaign& campaign) {
  const auto effects = fit.hypothesis.effects();
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const OutsideCause* const cause = find_outside(effects[e].effect);
    if (cause == nullptr) continue;
    OutsideFinding found;
    found.cause = cause->name;
    found.words = cause->words(fit.hypothesis.outside_values(cause->name, fit.x), campaign);
    found.parameters = parameters_of(fit, e, false);
    return found;
  }
  return std::nullopt;
}

std::vector<LeastDetectable> least_detectable_of(std::span<const ScreenedVariant> screened,
                                                 const DescriptionOptions& options) {
  std::vector<LeastDetectable> least;
  for (const ScreenedVariant& s : screened) {
    if (s.visibility <= 0.0) continue;
    if (std::any_of(least.begin(), least.end(),
                    [&](const LeastDetectable& l) { return l.effect == s.variant.effect; }))
      continue;
    const EffectVariant::Free& free = s.variant.free.front();
    least.push_back({s.variant.effect, free.field, options.surely_seen * free.std / s.visibility});
  }
  return least;
}

double hidden_share(std::span<const ScreenedVariant> screened, const DescriptionOptions& options) {
  constexpr double kHalf = 0.5;  // of the usual size
  if (screened.empty()) return 1.0;
  const auto hidden = std::count_if(screened.begin(), screened.end(), [&](const ScreenedVariant& s) {
    return s.visibility * kHalf < options.surely_seen;
  });
  return static_cast<double>(hidden) / static_cast<double>(screened.size());
}

double gain_of_parameters(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                          const DiagnosisOptions& options) {
  const FittedExplanation& null = *prepared.null;
  const Hypothesis pinned(campaign, {}, FreeNuisances::kClosures);
  std::vector<double> start;
  for (const Parameter& closure : pinned.parameters())
    for (std::size_t p = 0; p < null.x.size(); ++p)
      if (null.hypothesis.parameters()[p].name == closure.name) start.push_back(null.x[p]);
  const FittedExplanation nominal =
      fit_explanation(pinned, *prepared.model, *prepared.noise, start, options.fit, options.search.threads);
  const auto evidence = [&](const FittedExplanation& fit) {
    const Eigen::MatrixXd no_form(fit.white_jacobian.rows(), 0);
    const DiscrepancyGain gain =
        discrepancy_gain(fit, whitened(fit, *prepared.noise, prepared.discrepancy), no_form,
                         options.discrepancy, [&] { return prepared.model->cancelled(); });
    return fit.log_evidence + gain.imprecision;
  };
  return evidence(null) - evidence(nominal);
}

}  // namespace slipway::gap
