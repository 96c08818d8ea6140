#include "gap/explanation_search.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "core/parallel_for.h"
#include "gap/soft_patch_search.h"
#include "sim/effect_catalogue.h"

namespace slipway::gap {
namespace {

const std::string kSoftPatch = "soft_patch";
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
constexpr std::array kBeliefs{Belief{kBelievedShare, 0.7}, Belief{0.1 * kBelievedShare, 0.3}};
constexpr std::array kAllOfIt{Belief{1.0, 1.0}};

ExplanationOptions fit_options(const SearchOptions& options) {
  ExplanationOptions o;
  o.threads = options.threads;
  return o;
}

// Linear evidence of columns beside a fit, one-sided ones kept on their side, and the estimate.
double linear_gain(const FittedExplanation& fit, const Eigen::MatrixXd& known, const Eigen::MatrixXd& columns,
                   std::span<const Parameter> parameters, Eigen::VectorXd& estimate) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) kept.push_back(c);
  estimate = Eigen::VectorXd::Zero(columns.cols());
  const double without = log_marginal(fit.white_linear, known);
  for (;;) {
    if (kept.empty()) return 0.0;
    Eigen::MatrixXd all(columns.rows(), known.cols() + static_cast<Eigen::Index>(kept.size()));
    all << known, columns(Eigen::all, kept);
    Eigen::MatrixXd hessian = all.transpose() * all;
    hessian.diagonal().array() += 1.0;
    const Eigen::VectorXd solved = hessian.llt().solve(all.transpose() * fit.white_linear).tail(kept.size());
    std::vector<Eigen::Index> allowed;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const Parameter& p = parameters[static_cast<std::size_t>(kept[i])];
      const double value = p.neutral + p.std * solved[static_cast<Eigen::Index>(i)];
      if ((p.lowest == p.neutral && value < p.neutral) || (p.highest == p.neutral && value > p.neutral))
        continue;
      allowed.push_back(kept[i]);
    }
    if (allowed.size() == kept.size()) {
      double gain = log_marginal(fit.white_linear, all) - without;
      for (std::size_t i = 0; i < kept.size(); ++i) {
        const Parameter& p = parameters[static_cast<std::size_t>(kept[i])];
        estimate[kept[i]] = std::clamp(solved[static_cast<Eigen::Index>(i)], (p.lowest - p.neutral) / p.std,
                                       (p.highest - p.neutral) / p.std);
        if (p.lowest == p.neutral || p.highest == p.neutral) gain += std::log(2.0);
      }
      return gain;
    }
    kept = std::move(allowed);
  }
}

struct Screened {
  std::size_t variant = 0;
  double gain = 0.0;
  std::vector<double> start;  // of the hypothesis with it
  Eigen::VectorXd signature;
  double kept_share = 0.0, visibility = 0.0;
};

// Every variant beside a fit whose effects are not among them.
std::vector<Screened> screen(const DriveCampaign& campaign, const WindowModel& model, const NoiseModel& noise,
                             const FittedExplanation& fit, const Wildcard& wildcard,
                             std::span<const EffectVariant> variants, std::size_t threads) {
  std::vector<Screened> all(variants.size());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(fit.white_jacobian);
  const Eigen::MatrixXd basis =
      qr.householderQ() * Eigen::MatrixXd::Identity(fit.white_jacobian.rows(), fit.white_jacobian.cols());
  Eigen::MatrixXd known(fit.white_jacobian.rows(), fit.white_jacobian.cols() + wildcard.values.cols());
  known << fit.white_jacobian, kImprecision * whitened(fit, noise, wildcard);
  parallel_for(variants.size(), threads, [&](std::size_t v) {
    if (model.cancelled()) return;
    std::vector<EffectVariant> effects(fit.hypothesis.effects().begin(), fit.hypothesis.effects().end());
    for (const EffectVariant& there : effects)
      if (there.effect == variants[v].effect) {
        all[v] = {v, -1e9, {}, {}, 0.0, 0.0};
        return;
      }
    effects.push_back(variants[v]);
    const Hypothesis hypothesis(campaign, effects);
    std::vector<double> start;
    const Eigen::MatrixXd columns = added_columns(hypothesis, model, noise, fit, start);
    Eigen::VectorXd estimate;
    const auto added = hypothesis.parameters().subspan(fit.x.size());
    const double gain = linear_gain(fit, known, columns, added, estimate);
    for (std::size_t p = 0; p < added.size(); ++p)
      start[fit.x.size() + p] =
          std::clamp(added[p].neutral + added[p].std * estimate[static_cast<Eigen::Index>(p)],
                     added[p].lowest, added[p].highest);
    // What the found combination does; of one that is not there, the first field.
    Eigen::VectorXd direction = columns * estimate;
    if (estimate.squaredNorm() == 0.0) direction = columns.col(0);
    const Eigen::VectorXd projected = direction - basis * (basis.transpose() * direction);
    const double length = direction.norm();
    const Eigen::VectorXd first = columns.col(0) - basis * (basis.transpose() * columns.col(0));
    all[v] = {v,           gain, std::move(start), projected, length > 0.0 ? projected.norm() / length : 0.0,
              first.norm()};
  });
  std::stable_sort(all.begin(), all.end(),
                   [](const Screened& a, const Screened& b) { return a.gain > b.gain; });
  return all;
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

}  // namespace

Result<ExplanationSearch> search_explanations(const DriveCampaign& campaign, const WindowModel& model,
                                              const NoiseModel& noise, FittedExplanation null,
                                              const Wildcard& wildcard, const SearchOptions& options,
                                              Progress& progress,
                                              std::span<const FittedExplanation> found_before) {
  ExplanationSearch search;
  std::vector<EffectVariant> variants = effect_variants(*campaign.rover, options.withheld);
  std::map<std::string, double> variants_of;
  for (const EffectVariant& v : variants) ++variants_of[v.effect];
  if (std::find(options.withheld.begin(), options.withheld.end(), kSoftPatch) == options.withheld.end()) {
    progress.report("looking for soft places", 0.18);
    const PatchSearch patches = search_soft_patches(campaign, model, noise, null, kMostPatches);
    variants.insert(variants.end(), patches.variants.begin(), patches.variants.end());
    variants_of[kSoftPatch] = static_cast<double>(patches.looks);
  }
  const auto families = static_cast<double>(variants_of.size());
  search.fits.push_back(std::move(null));

  // One fit for each of the best effects, of its best variants.
  progress.report("screening effects", 0.2);
  std::vector<Screened> screened =
      screen(campaign, model, noise, search.fits[0], wildcard, variants, options.threads);
  std::map<std::size_t, std::vector<double>> other_start;  // of a variant
  if (went_far(search.fits[0])) {
    const FittedExplanation nominal = at_nominal(search.fits[0], model, noise, options);
    const std::vector<Screened> fresh =
        screen(campaign, model, noise, nominal, wildcard, variants, options.threads);
    for (const Screened& f : fresh) {
      other_start[f.variant] = f.start;
      for (Screened& s : screened)
        if (s.variant == f.variant) s.gain = std::max(s.gain, f.gain);
    }
    std::stable_sort(screened.begin(), screened.end(),
                     [](const Screened& a, const Screened& b) { return a.gain > b.gain; });
  }
  for (const Screened& s : screened)
    search.screened.push_back({variants[s.variant], s.gain, s.signature, s.kept_share, s.visibility});
  std::map<std::string, int> tried;
  std::map<std::string, std::size_t> best_fit;  // of an effect alone
  std::map<std::set<std::string>, std::size_t> pairs;
  for (const FittedExplanation& before : found_before) {
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
    std::set<std::string> names;
    for (const EffectVariant& v : before.hypothesis.effects()) names.insert(v.effect);
    if (names.empty()) continue;
    progress.report("fitting what was found again", 0.22);
    search.fits.push_back(fit_explanation(before.hypothesis, model, noise, before.x, fit_options(options)));
    if (names.size() == 1) {
      best_fit[*names.begin()] = search.fits.size() - 1;
      tried[*names.begin()] = kMostVariants;
    } else {
      pairs[names] = search.fits.size() - 1;
    }
  }
  for (const Screened& s : screened) {
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
    const EffectVariant& v = variants[s.variant];
    const bool known = tried.contains(v.effect);
    if (!known && static_cast<int>(tried.size()) >= options.most_refitted) continue;
    if (tried[v.effect] >= kMostVariants) continue;
    ++tried[v.effect];
    progress.report("fitting effects",
                    0.25 + 0.3 * static_cast<double>(search.fits.size()) / (2.0 * options.most_refitted));
    FittedExplanation fit =
        fit_explanation(Hypothesis(campaign, {v}), model, noise, s.start, fit_options(options));
    if (const auto other = other_start.find(s.variant); other != other_start.end()) {
      FittedExplanation second =
          fit_explanation(fit.hypothesis, model, noise, other->second, fit_options(options));
      if (second.log_evidence > fit.log_evidence) fit = std::move(second);
    }
    if (v.effect == kSoftPatch && tried[v.effect] == 1)
      fit = refine_soft_patch(campaign, model, noise, std::move(fit), fit_options(options));
    search.fits.push_back(std::move(fit));
    const std::size_t index = search.fits.size() - 1;
    const auto best = best_fit.find(v.effect);
    if (best == best_fit.end() || search.fits[index].log_evidence > search.fits[best->second].log_evidence)
      best_fit[v.effect] = index;
  }
  std::vector<std::pair<std::string, std::size_t>> singles(best_fit.begin(), best_fit.end());
  std::stable_sort(singles.begin(), singles.end(), [&](const auto& a, const auto& b) {
    return search.fits[a.second].log_evidence > search.fits[b.second].log_evidence;
  });

  // Pairs grow from the best single effects.
  for (std::size_t s = 0; s < singles.size() && s < static_cast<std::size_t>(options.most_paired); ++s) {
    const std::size_t base = singles[s].second;
    const std::vector<Screened> seconds =
        screen(campaign, model, noise, search.fits[base], wildcard, variants, options.threads);
    int fitted = 0;
    std::set<std::string> done;
    for (const Screened& second : seconds) {
      if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
      if (fitted >= options.most_seconds || second.start.empty()) break;
      if (second.gain < 1.0 && !options.told) break;
      const EffectVariant& v = variants[second.variant];
      const std::set<std::string> names{singles[s].first, v.effect};
      if (pairs.contains(names) || !done.insert(v.effect).second) continue;
      progress.report("fitting pairs of effects", 0.55 + 0.08 * static_cast<double>(s));
      std::vector<EffectVariant> effects(search.fits[base].hypothesis.effects().begin(),
                                         search.fits[base].hypothesis.effects().end());
      effects.push_back(v);
      search.fits.push_back(
          fit_explanation(Hypothesis(campaign, effects), model, noise, second.start, fit_options(options)));
      pairs[names] = search.fits.size() - 1;
      ++fitted;
    }
  }

  const double log_single = std::log(kOne / families);
  const double log_pair = std::log(kTwo / std::max(1.0, 0.5 * families * (families - 1.0)));
  const auto add = [&](std::size_t fit, double log_prior, double log_prior_unknown) {
    if (model.cancelled()) return;
    Candidate c;
    for (const EffectVariant& v : search.fits[fit].hypothesis.effects()) {
      c.effects.push_back(v.effect);
      log_prior -= std::log(variants_of[v.effect]);
      log_prior_unknown -= std::log(variants_of[v.effect]);
    }
    if (options.told ? fit != 0 && c.effects.size() < variants_of.size()
                     : !worth_naming(search.fits[fit], options.least_size))
      return;
    c.fit = fit;
    const WildcardGain gain =
        wildcard_gain(search.fits[fit], noise, wildcard,
                      form_columns(campaign, model, noise, search.fits[fit], options.threads));
    c.log_evidence = search.fits[fit].log_evidence + gain.imprecision;
    c.log_prior = log_prior;
    search.candidates.push_back(c);
    if (options.told || !options.something_else) return;
    c.with_unknown = true;
    c.log_evidence = search.fits[fit].log_evidence + gain.something_else;
    c.log_prior = log_prior_unknown;
    search.candidates.push_back(c);
  };
  if (!options.told) add(0, std::log(kNothing), std::log(kSomethingElse));
  for (const auto& [effect, fit] : singles) add(fit, log_single, std::log(kOneAndSomethingElse / families));
  for (const auto& [names, fit] : pairs) add(fit, log_pair, log_pair - 2.0);
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
  if (search.candidates.empty()) add(0, 0.0, 0.0);
  weigh(search.candidates, options);
  std::stable_sort(search.candidates.begin(), search.candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.probability > b.probability; });
  return search;
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
