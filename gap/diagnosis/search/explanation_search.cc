#include "gap/diagnosis/search/explanation_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "gap/diagnosis/model/outside_cause.h"
#include "gap/diagnosis/search/known_variants.h"
#include "gap/diagnosis/search/own_scatter.h"
#include "gap/diagnosis/search/soft_patch_search.h"

namespace slipway::gap {
namespace {

// Collects fits of sets of effects, and lets them compete.
class Searcher {
 public:
  Searcher(const DriveCampaign& campaign, const WindowModel& model, const NoiseModel& noise,
           FittedExplanation null, const DiscrepancyTerm& discrepancy, const DiagnosisOptions& options,
           Progress& progress)
      : campaign_(campaign),
        model_(model),
        noise_(noise),
        discrepancy_(discrepancy),
        options_(options),
        progress_(progress),
        variants_(campaign, model, noise, discrepancy, options_) {
    progress.report("looking for soft places", 0.0);
    variants_.add_places_beside(null);
    progress.report("screening effects", 0.04);
    variants_.screen(null);
    search_.fits.push_back(std::move(null));
    for (const ScreenedEffect& s : variants_.screened())
      (is_outside(variants_[s.variant].effect) ? search_.screened_outside : search_.screened)
          .push_back({variants_[s.variant], s.gain, s.signature, s.kept_share, s.visibility, s.reach,
                      s.columns, s.taken_by});
  }

  Searcher(const Searcher&) = delete;  // variants_ refers to options_
  Searcher& operator=(const Searcher&) = delete;

  void fit_again(std::span<const FittedExplanation> found_before) {
    for (const FittedExplanation& before : found_before) {
      if (progress_.cancelled()) return;
      std::set<std::string> names;
      for (const EffectVariant& v : before.hypothesis.effects()) names.insert(v.effect);
      if (names.empty()) continue;
      progress_.report("fitting what was found again", 0.08);
      const std::size_t index = add_fit(before.hypothesis, before.x);
      if (names.size() == 1) {
        best_fit_[*names.begin()] = index;
        tried_[*names.begin()] = options_.search.max_variants;
      } else {
        pairs_[names] = index;
      }
    }
  }

  // The best variants of the best effects.
  void fit_singles() {
    for (const ScreenedEffect& s : variants_.screened()) {
      if (progress_.cancelled()) return;
      const EffectVariant& v = variants_[s.variant];
      const bool known = tried_.contains(v.effect), outside = is_outside(v.effect);
      const auto alike = std::count_if(tried_.begin(), tried_.end(),
                                       [&](const auto& t) { return is_outside(t.first) == outside; });
      if (!known && alike >= (outside ? options_.search.max_outside : options_.search.max_refitted)) continue;
      if (tried_[v.effect] >= options_.search.max_variants) continue;
      ++tried_[v.effect];
      progress_.report("fitting effects",
                       0.1 + 0.4 * std::min(1.0, static_cast<double>(search_.fits.size()) /
                                                     (2.0 * options_.search.max_refitted)));
      const std::size_t index = add_fit(Hypothesis(campaign_, {v}), s, search_.fits[0]);
      FittedExplanation& fit = search_.fits[index];
      if (const std::vector<double>* const other = variants_.start_from_nominal(s.variant))
        keep_better(fit, fitted(fit.hypothesis, *other, fit.log_evidence));
      if (place_of(v) && tried_[v.effect] == 1)
        fit = refine_soft_patch(campaign_, model_, noise_, std::move(fit), options_.fit, options_.soft_patch,
                                options_.search.threads);
      evidence_of_[s.variant] = fit.log_evidence;
      const auto best = best_fit_.find(v.effect);
      if (best == best_fit_.end() || fit.log_evidence > search_.fits[best->second].log_evidence)
        best_fit_[v.effect] = index;
    }
    singles_.assign(best_fit_.begin(), best_fit_.end());
    for (const auto& [effect, index] : singles_) {
      if (progress_.cancelled()) return;
      FittedExplanation& fit = search_.fits[index];
      // Re-tuned soils may stand in an effect's place, unless a reference has told of them.
      const bool may_be_replaced = !campaign_.reference && !is_outside(effect);
      if (!may_be_replaced && !went_far(fit, options_.search.max_linear_shift)) continue;
      fit_from_neutral(fit);
      if (const ScreenedEffect* const at = variants_.screened_as(fit.hypothesis.effects().front()))
        evidence_of_[at->variant] = fit.log_evidence;
    }
    sort_singles();
  }

  // They grow from the best single effects, by seconds that promise a gain of so much at least. Causes from
  // outside that are as good grow pairs too, and take no effect's place.
  void fit_pairs(double min_gain) {
    std::vector<std::size_t> seconds = possible_seconds();
    const auto most = static_cast<std::size_t>(options_.search.max_paired);
    std::size_t effects_paired = 0;
    for (std::size_t s = 0; s < singles_.size() && effects_paired < most; ++s) {
      const std::size_t base = singles_[s].second;
      const bool base_outside = is_outside(singles_[s].first);
      if (base_outside && s >= most) continue;
      effects_paired += base_outside ? 0 : 1;
      int fitted = 0, outside = 0;
      std::set<std::string> done;
      // Places that nothing but this effect leaves to be seen.
      const std::size_t known = variants_.count();
      if (!base_outside && !placed_effect(search_.fits[base]))
        variants_.add_places_beside(search_.fits[base]);
      for (std::size_t v = known; v < variants_.count(); ++v) seconds.push_back(v);
      for (const ScreenedEffect& second : variants_.beside(search_.fits[base], seconds)) {
        if (progress_.cancelled()) return;
        if (second.start.empty() || second.gain < min_gain) break;
        const EffectVariant& v = variants_[second.variant];
        const bool from_outside = is_outside(v.effect);
        if (from_outside && (base_outside || outside >= options_.search.max_outside_seconds)) continue;
        if (!from_outside && fitted >= options_.search.max_seconds) continue;
        const std::set<std::string> names{singles_[s].first, v.effect};
        if (pairs_.contains(names) || !done.insert(v.effect).second) continue;
        progress_.report("fitting pairs of effects",
                         0.4 + 0.1 * static_cast<double>(std::max(effects_paired, std::size_t{1})));
        std::vector<EffectVariant> effects(search_.fits[base].hypothesis.effects().begin(),
                                           search_.fits[base].hypothesis.effects().end());
        effects.push_back(v);
        const std::size_t pair = pairs_[names] =
            add_fit(Hypothesis(campaign_, effects), second, search_.fits[base]);
        if (went_far(search_.fits[base], options_.search.max_linear_shift) ||
            went_far(search_.fits[pair], options_.search.max_linear_shift))
          fit_from_neutral(search_.fits[pair]);
        ++(from_outside ? outside : fitted);
      }
    }
  }

  // What a pair found of soils and closures, or of the place, may be better without its second effect, too.
  void fit_without_seconds() {
    for (const auto& [effect, single] : singles_) {
      FittedExplanation& fit = search_.fits[single];
      if (progress_.cancelled()) return;
      if (!went_far(fit, options_.search.max_linear_shift) && !placed_effect(fit)) continue;
      const FittedExplanation* best = &fit;
      for (const auto& [names, pair] : pairs_)
        if (names.contains(effect) && search_.fits[pair].log_evidence > best->log_evidence)
          best = &search_.fits[pair];
      if (best == &fit) continue;
      const auto effects = best->hypothesis.effects();
      const auto own = std::find_if(effects.begin(), effects.end(),
                                    [&](const EffectVariant& v) { return v.effect == effect; });
      const Hypothesis alone(campaign_, {*own});
      keep_better(fit, fitted(alone, started_at(alone, *best), fit.log_evidence));
    }
  }

  // All that was fitted and is worth a name against each other, nothing, and something else.
  Result<ExplanationSearch> compete() && {
    const auto outside = static_cast<double>(variants_.outside());
    const auto effects = static_cast<double>(variants_.effects());
    add_candidates(0, log_prior_of_nothing(options_.priors));
    for (const auto& [effect, fit] : singles_)
      if (worth_naming(search_.fits[fit], options_.search.min_named_size))
        add_candidates(fit, is_outside(effect) ? log_prior_of_outside(options_.priors, outside)
                                               : log_prior_of_one(options_.priors, effects));
    for (const auto& [names, fit] : pairs_)
      if (worth_naming(search_.fits[fit], options_.search.min_named_size))
        add_candidates(fit, std::any_of(names.begin(), names.end(), is_outside)
                                ? log_prior_of_one_and_outside(options_.priors, effects, outside)
                                : log_prior_of_two(options_.priors, effects));
    return std::move(*this).weighed();
  }

  // Only what has every effect of the library; nothing, where none was fitted.
  Result<ExplanationSearch> given() && {
    options_.search.something_else = false;
    const std::size_t all = variants_.effects();
    if (all == 1)
      for (const auto& [effect, fit] : singles_) add_candidates(fit, {});
    for (const auto& [names, fit] : pairs_)
      if (names.size() == all) add_candidates(fit, {});
    if (search_.candidates.empty()) add_candidates(0, {});
    return std::move(*this).weighed();
  }

 private:
  // Variants that pairs are looked for among: all of the library, and of the causes from outside the best of
  // those that were fitted alone.
  std::vector<std::size_t> possible_seconds() const {
    std::vector<std::size_t> seconds;
    std::set<std::string> outside;
    for (const ScreenedEffect& s : variants_.screened()) {
      const std::string& name = variants_[s.variant].effect;
      if (!is_outside(name) || (best_fit_.contains(name) && outside.insert(name).second))
        seconds.push_back(s.variant);
    }
    std::sort(seconds.begin(), seconds.end());
    return seconds;
  }

  // Given up where it would come neither near the best fit nor to what it competes with.
  FittedExplanation fitted(const Hypothesis& hypothesis, const ModeStart& start,
                           double must_reach = kAnyEvidence) const {
    return fit_explanation(hypothesis, model_, noise_, start, options_.fit, options_.search.threads, {},
                           std::max(must_reach, best_evidence() - options_.search.max_behind));
  }
  double best_evidence() const {
    double best = kAnyEvidence;
    for (const FittedExplanation& fit : search_.fits) best = std::max(best, fit.log_evidence);
    return best;
  }
  std::size_t add_fit(const Hypothesis& hypothesis, const ModeStart& start) {
    search_.fits.push_back(fitted(hypothesis, start));
    return search_.fits.size() - 1;
  }
  // A variant that was screened beside a fit, with the derivatives that screening took there.
  std::size_t add_fit(const Hypothesis& hypothesis, const ScreenedEffect& screened,
                      const FittedExplanation& beside) {
    const std::vector<double> at = started_at(hypothesis, beside);
    Eigen::MatrixXd jacobian(beside.jacobian.rows(), beside.jacobian.cols() + screened.columns.cols());
    jacobian << beside.jacobian, screened.columns;
    return add_fit(hypothesis, {screened.start, at, beside.residuals, jacobian});
  }

  void sort_singles() {
    std::stable_sort(singles_.begin(), singles_.end(), [&](const auto& a, const auto& b) {
      return search_.fits[a.second].log_evidence > search_.fits[b.second].log_evidence;
    });
  }

  // An effect starts where soils and closures were re-tuned in its place, and the second of a pair where they
  // were beside the first alone, which may be a dead end: a strong `multipass` once came out at 0 there, 81
  // of log evidence below the best. So it is fitted again from what was believed of them, with the effects at
  // half of their usual sizes at least.
  void fit_from_neutral(FittedExplanation& fit) const {
    if (fit.log_evidence < best_evidence() - options_.search.out_of_reach) return;
    std::vector<double> start = fit.hypothesis.neutral();
    for (std::size_t p = fit.hypothesis.nuisance_count(); p < start.size(); ++p) {
      const Parameter& parameter = fit.hypothesis.parameters()[p];
      const double off = fit.x[p] - parameter.neutral, half = 0.5 * parameter.std;
      const double sense = off < 0.0 || parameter.highest <= parameter.neutral ? -1.0 : 1.0;
      start[p] += std::abs(off) < half ? sense * half : off;
    }
    keep_better(fit, fitted(fit.hypothesis, start, fit.log_evidence));
  }

  // By how much less evidence an effect has in its other ways, alone: by fits where both were fitted,
  // otherwise by screening. Places are no ways but looks, of which each is another effect.
  std::vector<double> other_variants(const EffectVariant& own) const {
    if (place_of(own)) return {};
    const ScreenedEffect* const at = variants_.screened_as(own);
    if (at == nullptr) return {};
    const auto own_evidence = evidence_of_.find(at->variant);
    std::vector<double> less;
    for (const ScreenedEffect& s : variants_.screened()) {
      if (s.variant == at->variant || variants_[s.variant].effect != own.effect) continue;
      const auto evidence = evidence_of_.find(s.variant);
      const bool fitted = evidence != evidence_of_.end() && own_evidence != evidence_of_.end();
      less.push_back(std::min(0.0, fitted ? evidence->second - own_evidence->second : s.gain - at->gain));
    }
    return less;
  }

  // A set, alone and with something else besides.
  void add_candidates(std::size_t index, LogPrior prior) {
    if (model_.cancelled()) return;
    Candidate c;
    const FittedExplanation& fit = search_.fits[index];
    for (const EffectVariant& v : fit.hypothesis.effects()) {
      c.effects.push_back(v.effect);
      prior.alone -= std::log(variants_.ways_of(v.effect));
      prior.with_something_else -= std::log(variants_.ways_of(v.effect));
      const OutsideCause* const cause = find_outside(v.effect);
      c.outside = c.outside || cause != nullptr;
      if (cause == nullptr || !cause->twin_of_an_effect) continue;
      prior.alone += std::log(options_.priors.twin_share);
      prior.with_something_else += std::log(options_.priors.twin_share);
    }
    c.fit = index;
    for (const EffectVariant& v : fit.hypothesis.effects()) c.other_variants.push_back(other_variants(v));
    c.scatter = noise_.scales();
    const DiscrepancyGain gain = discrepancy_gain(campaign_, model_, noise_, fit, discrepancy_, options_);
    c.log_evidence = fit.log_evidence + gain.imprecision;
    c.log_prior = prior.alone;
    search_.candidates.push_back(c);
    if (!options_.search.something_else) return;
    c.with_unknown = true;
    c.log_evidence = fit.log_evidence + gain.something_else;
    c.log_prior = prior.with_something_else;
    search_.candidates.push_back(c);
  }

  Result<ExplanationSearch> weighed() && {
    const auto cancelled = [] { return fail(ErrorCode::kCancelled, "the diagnosis was cancelled"); };
    if (progress_.cancelled()) return cancelled();  // and there may be no candidates
    compare_with_own_scatter(campaign_, model_, noise_, discrepancy_, options_, progress_, search_);
    if (progress_.cancelled()) return cancelled();
    rank(search_.candidates, options_.evidence);
    return std::move(search_);
  }

  const DriveCampaign& campaign_;
  const WindowModel& model_;
  const NoiseModel& noise_;
  const DiscrepancyTerm& discrepancy_;
  DiagnosisOptions options_;
  Progress& progress_;
  KnownVariants variants_;
  std::map<std::string, int> tried_;
  std::map<std::size_t, double> evidence_of_;                 // of a variant that was fitted alone
  std::map<std::string, std::size_t> best_fit_;               // of an effect alone
  std::vector<std::pair<std::string, std::size_t>> singles_;  // the same, best first
  std::map<std::set<std::string>, std::size_t> pairs_;
  ExplanationSearch search_;
};

// Whether the second has every effect of the first.
bool is_part_of(const Candidate& part, const Candidate& whole) {
  return std::all_of(part.effects.begin(), part.effects.end(), [&](const std::string& effect) {
    return std::find(whole.effects.begin(), whole.effects.end(), effect) != whole.effects.end();
  });
}

}  // namespace

Result<ExplanationSearch> search_explanations(const DriveCampaign& campaign, const WindowModel& model,
                                              const NoiseModel& noise, FittedExplanation null,
                                              const DiscrepancyTerm& discrepancy,
                                              const DiagnosisOptions& options, Progress& progress,
                                              std::span<const FittedExplanation> found_before) {
  Searcher searcher(campaign, model, noise, std::move(null), discrepancy, options, progress);
  searcher.fit_again(found_before);
  searcher.fit_singles();
  searcher.fit_pairs(options.search.min_pair_gain);
  searcher.fit_without_seconds();
  return std::move(searcher).compete();
}

Result<ExplanationSearch> fit_given_explanation(const DriveCampaign& campaign, const WindowModel& model,
                                                const NoiseModel& noise, FittedExplanation null,
                                                const DiscrepancyTerm& discrepancy,
                                                const DiagnosisOptions& options, Progress& progress,
                                                std::span<const FittedExplanation> found_before) {
  DiagnosisOptions library_alone = options;
  library_alone.search.outside = false;
  Searcher searcher(campaign, model, noise, std::move(null), discrepancy, library_alone, progress);
  searcher.fit_again(found_before);
  searcher.fit_singles();
  searcher.fit_pairs(-std::numeric_limits<double>::infinity());
  return std::move(searcher).given();
}

bool worth_naming(const FittedExplanation& fit, double min_size) {
  const auto effects = fit.hypothesis.effects();
  return std::all_of(effects.begin(), effects.end(),
                     [&](const EffectVariant& v) { return size_of(fit, v.effect) >= min_size; });
}

std::vector<FittedExplanation> most_probable_fits(const ExplanationSearch& search, std::size_t most) {
  std::vector<FittedExplanation> fits;
  std::set<std::size_t> taken;
  for (const Candidate& c : search.candidates)
    if (fits.size() < most && taken.insert(c.fit).second) fits.push_back(search.fits[c.fit]);
  for (const Candidate& c : search.candidates)
    if (is_part_of(c, search.candidates.front()) && taken.insert(c.fit).second)
      fits.push_back(search.fits[c.fit]);
  return fits;
}

}  // namespace slipway::gap
