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
  // besides.
  double alone = 0.0, with_something_else = 0.0;
};

// One explanation's scatter, searched from given scales.
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

  // From these scales, estimated anew in so many rounds. What is estimated is of linearised residuals,
  // without the fits' robust loss, and may be worse than the scales before: of all that is met the most
  // probable counts. Something else has scales of its own where there are rounds.
  ScatteredExplanation beside(const FittedExplanation& fit, const NoiseScales& from, int rounds) && {
    scatter_around(fit, model_, own_);
    own_.set(from, options_.search.threads);
    FittedExplanation last = refine_soft_patch(campaign_, model_, own_, fitted_again(fit), options_.fit,
                                               options_.soft_patch, options_.search.threads);
    ScatteredExplanation best{last, own_.scales(), evidence_of(last)};
    int best_round = -1;
    for (int round = 0; round < rounds && !model_.cancelled(); ++round) {
      estimate_beside(last, options_.discrepancy.imprecision);
      last = fitted_again(last);
      if (const double now = evidence_of(last); now > best.alone) {
        best = {last, own_.scales(), now};
        best_round = round;
      }
    }
    if (model_.cancelled()) return best;
    if (best_round + 1 < rounds) {
      scatter_around(best.fit, model_, own_);
      own_.set(best.scales, options_.search.threads);
      best.fit = fitted_again(best.fit);
      best.alone = evidence_of(best.fit);
    }
    const DiscrepancyGain gain = gain_of(best.fit);
    best.with_something_else = best.alone + gain.something_else;
    best.alone += gain.imprecision;
    if (!options_.search.something_else || rounds == 0) return best;
    estimate_beside(best.fit, 1.0);
    const FittedExplanation beside_else = fitted_again(best.fit);
    best.with_something_else =
        std::max(best.with_something_else, evidence_of(beside_else) + gain_of(beside_else).something_else);
    return best;
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

  DiscrepancyGain gain_of(const FittedExplanation& fit) const {
    return discrepancy_gain(campaign_, model_, own_, fit, discrepancy_, options_);
  }
  // Without any discrepancy.
  double evidence_of(const FittedExplanation& fit) const {
    return fit.log_evidence + own_.log_normalisation() - compared_with_;
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

// Where another fit found soils, closures and the effects that both have; what it does not have stays
// neutral.
std::vector<double> started_at(const Hypothesis& hypothesis, const FittedExplanation& other) {
  std::vector<double> start = hypothesis.neutral();
  const auto own = hypothesis.parameters(), there = other.hypothesis.parameters();
  for (std::size_t p = 0; p < own.size(); ++p)
    for (std::size_t q = 0; q < there.size(); ++q)
      if (own[p].name == there[q].name) start[p] = other.x[q];
  return start;
}

bool has_all_effects_of(const FittedExplanation& fit, const FittedExplanation& other) {
  const auto effects = fit.hypothesis.effects(), of_other = other.hypothesis.effects();
  return std::all_of(of_other.begin(), of_other.end(), [&](const EffectVariant& o) {
    return std::any_of(effects.begin(), effects.end(),
                       [&](const EffectVariant& v) { return v.effect == o.effect; });
  });
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
  const auto compare = [&](std::size_t index, const FittedExplanation& fit, const NoiseScales& from,
                           int rounds) {
    progress.report("estimating the scatter beside explanations", 0.74);
    ScatteredExplanation own =
        ScatterSearch(campaign, model, noise, discrepancy, options).beside(fit, from, rounds);
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
    return own;
  };
  const auto untouched_at = [&](const Hypothesis& hypothesis, std::span<const double> x) {
    FitOptions untouched = options.fit;
    untouched.max_iterations = 0;
    return fit_explanation(hypothesis, model, noise, x, untouched, options.search.threads);
  };
  const int rounds = options.preparation.scatter_rounds;
  std::vector<ScatteredExplanation> found;
  for (const std::size_t index : compared) {
    if (progress.cancelled()) return;
    found.push_back(compare(index, search.fits[index], noise.believed(), rounds));
  }
  // The others beside the scatter of the best, since their own may have led into a dead end: what has all of
  // its effects and more is no worse.
  const auto best_found = static_cast<std::size_t>(
      std::max_element(found.begin(), found.end(),
                       [](const auto& a, const auto& b) { return a.alone < b.alone; }) -
      found.begin());
  for (std::size_t i = 0; i < compared.size(); ++i) {
    if (progress.cancelled()) return;
    if (i == best_found) continue;
    const ScatteredExplanation& best = found[best_found];
    const FittedExplanation& own = found[i].fit;
    if (has_all_effects_of(own, best.fit))
      compare(compared[i], untouched_at(own.hypothesis, started_at(own.hypothesis, best.fit)), best.scales,
              0);
    else
      compare(compared[i], own, best.scales, 0);
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
      compare(
          index,
          fit_explanation(*there, model, noise, search.fits[index].x, options.fit, options.search.threads),
          noise.believed(), rounds);
  }
}

}  // namespace slipway::gap
