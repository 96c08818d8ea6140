#include "gap/diagnosis/search/own_scatter.h"

#include <algorithm>
#include <optional>
#include <span>
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

  // From these scales, estimated anew in so many rounds. A better place of its effect is looked for where it
  // comes to `must_reach`. Something else has scales of its own where there are rounds.
  ScatteredExplanation beside(const FittedExplanation& fit, const NoiseScales& from, int rounds,
                              double must_reach) && {
    const auto set_scales = [&] {
      scatter_around(fit, model_, own_);
      own_.set(from, options_.search.threads);
    };
    set_scales();
    const FittedExplanation first = fitted_again(fit);
    ScatteredExplanation best = estimated(first, rounds);
    if (placed_effect(fit) && best.alone >= must_reach) {
      set_scales();
      best = estimated(refine_soft_patch(campaign_, model_, own_, first, options_.fit, options_.soft_patch,
                                         options_.search.threads),
                       rounds);
    }
    if (model_.cancelled()) return best;
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
  // What is estimated is of linearised residuals, without the fits' robust loss, and may be worse than the
  // scales before: of all that is met the most probable counts.
  ScatteredExplanation estimated(FittedExplanation last, int rounds) {
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
    if (best_round + 1 == rounds || model_.cancelled()) return best;
    scatter_around(best.fit, model_, own_);
    own_.set(best.scales, options_.search.threads);
    best.fit = fitted_again(best.fit);
    best.alone = evidence_of(best.fit);
    return best;
  }

  FittedExplanation fitted_again(const FittedExplanation& fit) const {
    return fit_explanation(fit.hypothesis, model_, own_, ModeStart::at(fit), options_.fit,
                           options_.search.threads);
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

bool has_all_effects_of(const FittedExplanation& fit, const FittedExplanation& other) {
  const auto effects = fit.hypothesis.effects(), of_other = other.hypothesis.effects();
  return std::all_of(of_other.begin(), of_other.end(), [&](const EffectVariant& o) {
    return std::any_of(effects.begin(), effects.end(),
                       [&](const EffectVariant& v) { return v.effect == o.effect; });
  });
}

// The first, which has a part of the second's effects, with the effect that acts at a place where the second
// has it; none where it is there already.
std::optional<Hypothesis> at_place_of(const DriveCampaign& campaign, const FittedExplanation& fit,
                                      const FittedExplanation& other) {
  const auto own = placed_effect(fit), there = placed_effect(other);
  if (!own || !there || !has_all_effects_of(other, fit)) return std::nullopt;
  const auto effects = fit.hypothesis.effects(), of_other = other.hypothesis.effects();
  if (effects[*own].label == of_other[*there].label) return std::nullopt;
  std::vector<EffectVariant> moved(effects.begin(), effects.end());
  moved[*own] = of_other[*there];
  return Hypothesis(campaign, moved);
}

// Lets the foremost explanations of a search compete, each beside its own scatter.
class ScatterComparison {
 public:
  ScatterComparison(const DriveCampaign& campaign, const WindowModel& model, const NoiseModel& noise,
                    const DiscrepancyTerm& discrepancy, const DiagnosisOptions& options, Progress& progress,
                    ExplanationSearch& search)
      : campaign_(campaign),
        model_(model),
        noise_(noise),
        discrepancy_(discrepancy),
        options_(options),
        progress_(progress),
        search_(search),
        compared_(foremost(search.candidates, options.evidence,
                           static_cast<std::size_t>(options.search.max_scattered))) {}

  void run() {
    for (const std::size_t index : compared_) {
      if (progress_.cancelled()) return;
      found_.push_back(compare(index, search_.fits[index], noise_.believed(), rounds()));
    }
    look_at_best_place();
    share_best_scales();
  }

 private:
  int rounds() const { return options_.preparation.scatter_rounds; }

  // Where the best explanation found an effect at work, what has a part of its effects may not have looked.
  void look_at_best_place() {
    rank(search_.candidates, options_.evidence);
    const auto best =
        std::find_if(search_.candidates.begin(), search_.candidates.end(),
                     [&](const Candidate& c) { return placed_effect(search_.fits[c.fit]).has_value(); });
    if (best == search_.candidates.end()) return;
    const std::size_t best_fit = best->fit;
    for (std::size_t i = 0; i < compared_.size() && !progress_.cancelled(); ++i) {
      const std::vector<double> start = search_.fits[compared_[i]].x;
      const auto there = at_place_of(campaign_, search_.fits[compared_[i]], search_.fits[best_fit]);
      if (!there) continue;
      ScatteredExplanation moved =
          compare(compared_[i], fitted(*there, start, options_.fit), noise_.believed(), rounds());
      if (moved.alone > found_[i].alone) found_[i] = std::move(moved);
    }
  }

  // The others beside the scatter of the best, since their own may have led into a dead end; what has all of
  // its effects, or a part of them, from its soils too.
  void share_best_scales() {
    const auto less = [](const auto& a, const auto& b) { return a.alone < b.alone; };
    const ScatteredExplanation& best = *std::max_element(found_.begin(), found_.end(), less);
    FitOptions untouched = options_.fit;
    untouched.max_iterations = 0;
    for (std::size_t i = 0; i < compared_.size() && !progress_.cancelled(); ++i) {
      const FittedExplanation& own = found_[i].fit;
      if (&own == &best.fit) continue;
      const bool whole = has_all_effects_of(own, best.fit), part = has_all_effects_of(best.fit, own);
      if (!whole) compare(compared_[i], own, best.scales, 0);
      if (whole || part)
        compare(compared_[i], fitted(own.hypothesis, started_at(own.hypothesis, best.fit), untouched),
                best.scales, 0);
    }
  }

  // A fit of these explanations, or the same with its effect at another place, beside the scatter that is
  // searched from these scales in so many rounds. Its candidates keep it where it is the best so far.
  ScatteredExplanation compare(std::size_t index, const FittedExplanation& fit, const NoiseScales& from,
                               int rounds) {
    progress_.report("estimating the scatter beside explanations", 0.9);
    ScatteredExplanation own = ScatterSearch(campaign_, model_, noise_, discrepancy_, options_)
                                   .beside(fit, from, rounds, best_evidence() - options_.search.out_of_reach);
    bool better = false;
    for (Candidate& c : search_.candidates) {
      const double evidence = c.with_unknown ? own.with_something_else : own.alone;
      if (c.fit != index || evidence <= c.log_evidence) continue;
      c.log_evidence = evidence;
      c.scatter = own.scales;
      better = better || !c.with_unknown;
    }
    if (better && placed_effect(own.fit))
      search_.fits[index] = fitted(own.fit.hypothesis, own.fit.x, options_.fit);
    return own;
  }

  double best_evidence() const {
    double best = kAnyEvidence;
    for (const ScatteredExplanation& found : found_) best = std::max(best, found.alone);
    return best;
  }

  FittedExplanation fitted(const Hypothesis& hypothesis, std::span<const double> start,
                           const FitOptions& fit) const {
    return fit_explanation(hypothesis, model_, noise_, start, fit, options_.search.threads);
  }

  const DriveCampaign& campaign_;
  const WindowModel& model_;
  const NoiseModel& noise_;
  const DiscrepancyTerm& discrepancy_;
  const DiagnosisOptions& options_;
  Progress& progress_;
  ExplanationSearch& search_;
  std::vector<std::size_t> compared_;  // fits of the search, that of nothing first
  std::vector<ScatteredExplanation> found_;
};

}  // namespace

void compare_with_own_scatter(const DriveCampaign& campaign, const WindowModel& model,
                              const NoiseModel& noise, const DiscrepancyTerm& discrepancy,
                              const DiagnosisOptions& options, Progress& progress,
                              ExplanationSearch& search) {
  if (campaign.reference) return;
  ScatterComparison(campaign, model, noise, discrepancy, options, progress, search).run();
}

}  // namespace slipway::gap
