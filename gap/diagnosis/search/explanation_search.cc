#include "gap/diagnosis/search/explanation_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "gap/diagnosis/search/effect_screening.h"
#include "gap/diagnosis/search/soft_patch_search.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::gap {
namespace {

constexpr std::size_t kMostPatches = 3;
constexpr int kMostVariants = 2;  // of an effect, that are fitted in full

// What is believed before the drives: that nothing is missing, that one effect is, two are, something else. A
// diagnosis is asked for where something seems to be wrong.
constexpr double kNothing = 0.25, kOne = 0.375, kTwo = 0.125, kSomethingElse = 0.175,
                 kOneAndSomethingElse = 0.075;

// Shares of the evidence that are believed, and how often each; chosen on sealed campaigns, see
// docs/diagnosis.md.
struct Belief {
  double share, weight;
};
constexpr std::array kBeliefs{Belief{0.12, 0.7}, Belief{0.012, 0.3}};
constexpr std::array kAllOfIt{Belief{1.0, 1.0}};

ExplanationOptions fit_options(const SearchOptions& options) {
  ExplanationOptions o;
  o.threads = options.threads;
  return o;
}

// The fit that no iteration has moved from the nominal parameters.
FittedExplanation at_nominal(const FittedExplanation& null, const WindowModel& model, const NoiseModel& noise,
                             const SearchOptions& options) {
  ExplanationOptions untouched = fit_options(options);
  untouched.iterations = 0;
  return fit_explanation(null.hypothesis, model, noise, null.hypothesis.neutral(), untouched);
}

// A null that had to go this far from what was believed, in prior deviations, is no point from which effects
// look linear.
constexpr double kFar = 2.5;

bool went_far(const FittedExplanation& null) {
  const auto parameters = null.hypothesis.parameters();
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (std::abs(null.x[p] - parameters[p].neutral) > kFar * parameters[p].std) return true;
  return false;
}

// Whether each effect of a fit is at work by a good part of its usual size.
bool worth_naming(const FittedExplanation& fit, double least_size) {
  const auto effects = fit.hypothesis.effects();
  return std::all_of(effects.begin(), effects.end(),
                     [&](const EffectVariant& v) { return size_of(fit, v.effect) >= least_size; });
}

double log_sum_exp(const std::vector<double>& values) {
  const double most = *std::max_element(values.begin(), values.end());
  double sum = 0.0;
  for (const double v : values) sum += std::exp(v - most);
  return most + std::log(sum);
}

// Collects fits of sets of effects, and lets them compete.
class Searcher {
 public:
  Searcher(const DriveCampaign& campaign, const WindowModel& model, const NoiseModel& noise,
           FittedExplanation null, const DiscrepancyTerm& discrepancy, const SearchOptions& options,
           Progress& progress)
      : campaign_(campaign),
        model_(model),
        noise_(noise),
        discrepancy_(discrepancy),
        options_(options),
        progress_(progress),
        variants_(effect_variants(*campaign.rover, options.withheld)) {
    for (const EffectVariant& v : variants_) ++variants_of_[v.effect];
    for (const sim::Effect& effect : sim::effect_catalogue()) {
      const auto& withheld = options.withheld;
      if (effect.variant_at == nullptr ||
          std::find(withheld.begin(), withheld.end(), effect.name) != withheld.end())
        continue;
      progress.report("looking for soft places", 0.18);
      const PatchSearch patches = search_soft_patches(effect, campaign, model, noise, null, kMostPatches);
      variants_.insert(variants_.end(), patches.variants.begin(), patches.variants.end());
      variants_of_[std::string(effect.name)] = static_cast<double>(patches.looks);
    }
    search_.fits.push_back(std::move(null));
    progress.report("screening effects", 0.2);
    screen();
  }

  void fit_again(std::span<const FittedExplanation> found_before) {
    for (const FittedExplanation& before : found_before) {
      if (progress_.cancelled()) return;
      std::set<std::string> names;
      for (const EffectVariant& v : before.hypothesis.effects()) names.insert(v.effect);
      if (names.empty()) continue;
      progress_.report("fitting what was found again", 0.22);
      const std::size_t index = add_fit(before.hypothesis, before.x);
      if (names.size() == 1) {
        best_fit_[*names.begin()] = index;
        tried_[*names.begin()] = kMostVariants;
      } else {
        pairs_[names] = index;
      }
    }
  }

  // The best variants of the best effects.
  void fit_singles() {
    for (const ScreenedEffect& s : screened_) {
      if (progress_.cancelled()) return;
      const EffectVariant& v = variants_[s.variant];
      const bool known = tried_.contains(v.effect);
      if (!known && static_cast<int>(tried_.size()) >= options_.most_refitted) continue;
      if (tried_[v.effect] >= kMostVariants) continue;
      ++tried_[v.effect];
      progress_.report("fitting effects", 0.25 + 0.3 * static_cast<double>(search_.fits.size()) /
                                                     (2.0 * options_.most_refitted));
      const std::size_t index = add_fit(Hypothesis(campaign_, {v}), s.start);
      FittedExplanation& fit = search_.fits[index];
      if (const auto other = other_start_.find(s.variant); other != other_start_.end()) {
        FittedExplanation second = fitted(fit.hypothesis, other->second);
        if (second.log_evidence > fit.log_evidence) fit = std::move(second);
      }
      if (place_of(v) && tried_[v.effect] == 1)
        fit = refine_soft_patch(campaign_, model_, noise_, std::move(fit), fit_options(options_));
      const auto best = best_fit_.find(v.effect);
      if (best == best_fit_.end() || fit.log_evidence > search_.fits[best->second].log_evidence)
        best_fit_[v.effect] = index;
    }
    singles_.assign(best_fit_.begin(), best_fit_.end());
    std::stable_sort(singles_.begin(), singles_.end(), [&](const auto& a, const auto& b) {
      return search_.fits[a.second].log_evidence > search_.fits[b.second].log_evidence;
    });
  }

  // They grow from the best single effects, by seconds that promise a gain of so much at least.
  void fit_pairs(double least_gain) {
    for (std::size_t s = 0; s < singles_.size() && s < static_cast<std::size_t>(options_.most_paired); ++s) {
      const std::size_t base = singles_[s].second;
      int fitted = 0;
      std::set<std::string> done;
      for (const ScreenedEffect& second : screen_effects(campaign_, model_, noise_, search_.fits[base],
                                                         discrepancy_, variants_, options_.threads)) {
        if (progress_.cancelled()) return;
        if (fitted >= options_.most_seconds || second.start.empty() || second.gain < least_gain) break;
        const EffectVariant& v = variants_[second.variant];
        const std::set<std::string> names{singles_[s].first, v.effect};
        if (pairs_.contains(names) || !done.insert(v.effect).second) continue;
        progress_.report("fitting pairs of effects", 0.55 + 0.08 * static_cast<double>(s));
        std::vector<EffectVariant> effects(search_.fits[base].hypothesis.effects().begin(),
                                           search_.fits[base].hypothesis.effects().end());
        effects.push_back(v);
        pairs_[names] = add_fit(Hypothesis(campaign_, effects), second.start);
        ++fitted;
      }
    }
  }

  // All that was fitted and is worth a name against each other, nothing, and something else.
  Result<ExplanationSearch> compete() && {
    add_candidates(0, std::log(kNothing), std::log(kSomethingElse));
    for (const auto& [effect, fit] : singles_)
      if (worth_naming(search_.fits[fit], options_.least_size))
        add_candidates(fit, log_single(), std::log(kOneAndSomethingElse / families()));
    for (const auto& [names, fit] : pairs_)
      if (worth_naming(search_.fits[fit], options_.least_size))
        add_candidates(fit, log_pair(), log_pair() - 2.0);
    return std::move(*this).weighed();
  }

  // Only what has every effect of the library; nothing, where none was fitted.
  Result<ExplanationSearch> given() && {
    options_.something_else = false;
    if (variants_of_.size() == 1)
      for (const auto& [effect, fit] : singles_) add_candidates(fit, 0.0, 0.0);
    for (const auto& [names, fit] : pairs_)
      if (names.size() == variants_of_.size()) add_candidates(fit, 0.0, 0.0);
    if (search_.candidates.empty()) add_candidates(0, 0.0, 0.0);
    return std::move(*this).weighed();
  }

 private:
  // At the null, and at the nominal parameters where that had to go far from them.
  void screen() {
    screened_ =
        screen_effects(campaign_, model_, noise_, search_.fits[0], discrepancy_, variants_, options_.threads);
    if (went_far(search_.fits[0])) {
      const FittedExplanation nominal = at_nominal(search_.fits[0], model_, noise_, options_);
      for (const ScreenedEffect& f :
           screen_effects(campaign_, model_, noise_, nominal, discrepancy_, variants_, options_.threads)) {
        other_start_[f.variant] = f.start;
        for (ScreenedEffect& s : screened_)
          if (s.variant == f.variant) s.gain = std::max(s.gain, f.gain);
      }
      std::stable_sort(screened_.begin(), screened_.end(),
                       [](const ScreenedEffect& a, const ScreenedEffect& b) { return a.gain > b.gain; });
    }
    for (const ScreenedEffect& s : screened_)
      search_.screened.push_back({variants_[s.variant], s.gain, s.signature, s.kept_share, s.visibility});
  }

  FittedExplanation fitted(const Hypothesis& hypothesis, std::span<const double> start) const {
    return fit_explanation(hypothesis, model_, noise_, start, fit_options(options_));
  }
  std::size_t add_fit(const Hypothesis& hypothesis, std::span<const double> start) {
    search_.fits.push_back(fitted(hypothesis, start));
    return search_.fits.size() - 1;
  }

  double families() const { return static_cast<double>(variants_of_.size()); }
  double log_single() const { return std::log(kOne / families()); }
  double log_pair() const { return std::log(kTwo / std::max(1.0, 0.5 * families() * (families() - 1.0))); }

  // A set, alone and with something else besides.
  void add_candidates(std::size_t fit, double log_prior, double log_prior_unknown) {
    if (model_.cancelled()) return;
    Candidate c;
    for (const EffectVariant& v : search_.fits[fit].hypothesis.effects()) {
      c.effects.push_back(v.effect);
      log_prior -= std::log(variants_of_[v.effect]);
      log_prior_unknown -= std::log(variants_of_[v.effect]);
    }
    c.fit = fit;
    const DiscrepancyGain gain =
        discrepancy_gain(search_.fits[fit], noise_, discrepancy_,
                         form_columns(campaign_, model_, noise_, search_.fits[fit], options_.threads));
    c.log_evidence = search_.fits[fit].log_evidence + gain.imprecision;
    c.log_prior = log_prior;
    search_.candidates.push_back(c);
    if (!options_.something_else) return;
    c.with_unknown = true;
    c.log_evidence = search_.fits[fit].log_evidence + gain.something_else;
    c.log_prior = log_prior_unknown;
    search_.candidates.push_back(c);
  }

  Result<ExplanationSearch> weighed() && {
    if (progress_.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
    weigh(search_.candidates, options_);
    std::stable_sort(search_.candidates.begin(), search_.candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.probability > b.probability; });
    return std::move(search_);
  }

  const DriveCampaign& campaign_;
  const WindowModel& model_;
  const NoiseModel& noise_;
  const DiscrepancyTerm& discrepancy_;
  SearchOptions options_;
  Progress& progress_;
  std::vector<EffectVariant> variants_;
  std::map<std::string, double> variants_of_;  // how many each effect has, or places that were looked at
  std::vector<ScreenedEffect> screened_;
  std::map<std::size_t, std::vector<double>> other_start_;  // of a variant
  std::map<std::string, int> tried_;
  std::map<std::string, std::size_t> best_fit_;               // of an effect alone
  std::vector<std::pair<std::string, std::size_t>> singles_;  // the same, best first
  std::map<std::set<std::string>, std::size_t> pairs_;
  ExplanationSearch search_;
};

}  // namespace

Result<ExplanationSearch> search_explanations(const DriveCampaign& campaign, const WindowModel& model,
                                              const NoiseModel& noise, FittedExplanation null,
                                              const DiscrepancyTerm& discrepancy,
                                              const SearchOptions& options, Progress& progress,
                                              std::span<const FittedExplanation> found_before) {
  constexpr double kLeastGain = 1.0;
  Searcher searcher(campaign, model, noise, std::move(null), discrepancy, options, progress);
  searcher.fit_again(found_before);
  searcher.fit_singles();
  searcher.fit_pairs(kLeastGain);
  return std::move(searcher).compete();
}

Result<ExplanationSearch> fit_given_explanation(const DriveCampaign& campaign, const WindowModel& model,
                                                const NoiseModel& noise, FittedExplanation null,
                                                const DiscrepancyTerm& discrepancy,
                                                const SearchOptions& options, Progress& progress,
                                                std::span<const FittedExplanation> found_before) {
  Searcher searcher(campaign, model, noise, std::move(null), discrepancy, options, progress);
  searcher.fit_again(found_before);
  searcher.fit_singles();
  searcher.fit_pairs(-std::numeric_limits<double>::infinity());
  return std::move(searcher).given();
}

void weigh(std::span<Candidate> candidates, const SearchOptions& options) {
  for (Candidate& c : candidates) c.probability = 0.0;
  const std::span<const Belief> beliefs =
      options.whole_evidence ? std::span<const Belief>(kAllOfIt) : std::span<const Belief>(kBeliefs);
  for (const Belief& belief : beliefs) {
    std::vector<double> weights;
    for (const Candidate& c : candidates) weights.push_back(belief.share * c.log_evidence + c.log_prior);
    const double all = log_sum_exp(weights);
    for (std::size_t i = 0; i < weights.size(); ++i)
      candidates[i].probability += belief.weight * std::exp(weights[i] - all);
  }
}

std::vector<FittedExplanation> most_probable_fits(const ExplanationSearch& search, std::size_t most) {
  std::vector<FittedExplanation> fits;
  std::set<std::size_t> taken;
  for (const Candidate& c : search.candidates)
    if (fits.size() < most && taken.insert(c.fit).second) fits.push_back(search.fits[c.fit]);
  return fits;
}

}  // namespace slipway::gap
