#include "gap/diagnosis/search/own_scatter.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "gap/diagnosis/search/prepared_campaign.h"
#include "gap/diagnosis/search/soft_patch_search.h"

namespace slipway::gap {
namespace {

struct ScatteredExplanation {
  FittedExplanation fit;  // under these scales
  NoiseScales scales;
  // Logarithms of the evidence: with no more than the imprecision of any simulator, and with something else
  // besides, which has scales of its own.
  double alone = 0.0, with_something_else = 0.0;
};

// One explanation's scatter, searched from what was believed before the drives.
class ScatterSearch {
 public:
  ScatterSearch(const DriveCampaign& campaign, const WindowModel& model, const NoiseModel& noise,
                const DiscrepancyTerm& discrepancy, const DiagnosisOptions& options)
      : campaign_(campaign),
        model_(model),
        discrepancy_(discrepancy),
        options_(options),
        compared_with_(noise.log_normalisation()),
        own_(noise) {}

  ScatteredExplanation beside(const FittedExplanation& fit) && {
    scatter_around(fit, model_, own_);
    own_.set(own_.believed(), options_.search.threads);
    ScatteredExplanation found{refine_soft_patch(campaign_, model_, own_, fitted_again(fit), options_.fit,
                                                 options_.soft_patch, options_.search.threads),
                               {}};
    for (int round = 0; round < options_.preparation.scatter_rounds && !model_.cancelled(); ++round) {
      estimate_beside(found.fit, options_.discrepancy.imprecision);
      found.fit = fitted_again(found.fit);
    }
    found.scales = own_.scales();
    found.alone = evidence_of(found.fit, &DiscrepancyGain::imprecision);
    if (!options_.search.something_else || model_.cancelled()) return found;
    estimate_beside(found.fit, 1.0);
    found.with_something_else = evidence_of(fitted_again(found.fit), &DiscrepancyGain::something_else);
    return found;
  }

 private:
  FittedExplanation fitted_again(const FittedExplanation& fit) const {
    return fit_explanation(fit.hypothesis, model_, own_, fit.x, options_.fit, options_.search.threads);
  }

  void estimate_beside(const FittedExplanation& fit, double discrepancy_size) {
    scatter_around(fit, model_, own_);
    const LinearProblem problem = unwhitened_problem(fit, fit.hypothesis.parameters());
    Eigen::MatrixXd systematic(problem.columns.rows(), problem.columns.cols() + discrepancy_.values.cols());
    systematic << problem.columns, discrepancy_size * discrepancy_.values;
    own_.estimate(problem.residuals, systematic, options_.search.threads);
  }

  double evidence_of(const FittedExplanation& fit, double DiscrepancyGain::*part) const {
    const DiscrepancyGain gain = discrepancy_gain(campaign_, model_, own_, fit, discrepancy_, options_);
    return fit.log_evidence + gain.*part + own_.log_normalisation() - compared_with_;
  }

  const DriveCampaign& campaign_;
  const WindowModel& model_;
  const DiscrepancyTerm& discrepancy_;
  const DiagnosisOptions& options_;
  double compared_with_;
  NoiseModel own_;
};

// The fits of nothing and of the most probable candidates, `most` in all.
std::vector<std::size_t> foremost(std::vector<Candidate> candidates, const EvidenceOptions& evidence,
                                  std::size_t most) {
  rank(candidates, evidence);
  std::vector<std::size_t> fits{0};
  for (const Candidate& c : candidates)
    if (fits.size() < most && std::find(fits.begin(), fits.end(), c.fit) == fits.end()) fits.push_back(c.fit);
  return fits;
}

// The first, which has a part of the second's effects, with the effect that acts at a place where the second
// has it; none where it is there already.
std::optional<Hypothesis> at_place_of(const DriveCampaign& campaign, const FittedExplanation& fit,
                                      const FittedExplanation& other) {
  const auto own = placed_effect(fit), there = placed_effect(other);
  if (!own || !there) return std::nullopt;
  const auto effects = fit.hypothesis.effects(), of_other = other.hypothesis.effects();
  const bool part = std::all_of(effects.begin(), effects.end(), [&](const EffectVariant& v) {
    return std::any_of(of_other.begin(), of_other.end(),
                       [&](const EffectVariant& o) { return o.effect == v.effect; });
  });
  if (!part || effects[*own].label == of_other[*there].label) return std::nullopt;
  std::vector<EffectVariant> moved(effects.begin(), effects.end());
  moved[*own] = of_other[*there];
  return Hypothesis(campaign, moved);
}

}  // namespace

void compare_with_own_scatter(const DriveCampaign& campaign, const WindowModel& model,
                              const NoiseModel& noise, const DiscrepancyTerm& discrepancy,
                              const DiagnosisOptions& options, Progress& progress,
                              ExplanationSearch& search) {
  if (campaign.reference) return;
  const auto most = static_cast<std::size_t>(options.search.max_scattered);
  const std::vector<std::size_t> compared = foremost(search.candidates, options.evidence, most);
  // A fit, or the same with its effect at another place, beside its own scatter.
  const auto compare = [&](std::size_t index, const FittedExplanation& fit) {
    progress.report("estimating the scatter beside explanations", 0.74);
    const ScatteredExplanation own = ScatterSearch(campaign, model, noise, discrepancy, options).beside(fit);
    bool better = false;
    for (Candidate& c : search.candidates) {
      const double evidence = c.with_unknown ? own.with_something_else : own.alone;
      if (c.fit != index || evidence <= c.log_evidence) continue;
      c.log_evidence = evidence;
      c.scatter = own.scales;
      better = better || !c.with_unknown;
    }
    if (better && placed_effect(own.fit))
      search.fits[index] =
          fit_explanation(own.fit.hypothesis, model, noise, own.fit.x, options.fit, options.search.threads);
  };
  for (const std::size_t index : compared) {
    if (progress.cancelled()) return;
    compare(index, search.fits[index]);
  }
  // Where the best of them found an effect at work, a part of it may not have looked.
  rank(search.candidates, options.evidence);
  const auto best = std::find_if(search.candidates.begin(), search.candidates.end(), [&](const Candidate& c) {
    return placed_effect(search.fits[c.fit]).has_value();
  });
  if (best == search.candidates.end()) return;
  const std::size_t best_fit = best->fit;
  for (const std::size_t index : compared) {
    if (progress.cancelled()) return;
    if (const auto there = at_place_of(campaign, search.fits[index], search.fits[best_fit]))
      compare(index, fit_explanation(*there, model, noise, search.fits[index].x, options.fit,
                                     options.search.threads));
  }
}

}  // namespace slipway::gap
