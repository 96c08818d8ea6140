#include "gap/diagnosis/search/soft_patch_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "gap/diagnosis/search/linear_gain.h"

namespace slipway::gap {
namespace {

// A disc that holds every map, and the weakening by which the response to it is found: see weaker_everywhere.
constexpr double kWholeMap_m = 1000.0, kProbe = 0.1;
// Of the radius, by which a disc is moved, and how much less it is resized: they set only how fast it is
// found.
constexpr std::array kMoves{0.5, 0.25};
constexpr double kResize = 0.6;
constexpr int kMaxSweeps = 3, kMaxIterations = 3;

bool overlap(const sim::Disc& a, const sim::Disc& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m) < 0.5 * (a.radius_m + b.radius_m);
}

// The mean of all measured stations; nothing where there are none.
std::optional<sim::Disc> whole_map(std::span<const DriveWindow> windows) {
  double x_m = 0.0, y_m = 0.0;
  std::size_t count = 0;
  for (const DriveWindow& w : windows)
    for (const Pose2& pose : w.stations) {
      x_m += pose.x_m;
      y_m += pose.y_m;
      ++count;
    }
  if (count == 0) return std::nullopt;
  return sim::Disc{x_m / static_cast<double>(count), y_m / static_cast<double>(count), kWholeMap_m};
}

// What weaker soil everywhere would do to every observation beside all that is in the fit, for a prior
// deviation of the weakening.
Eigen::VectorXd weaker_everywhere(const DriveCampaign& campaign, const WindowModel& model,
                                  const FittedExplanation& fit, const sim::Effect& effect,
                                  const sim::Disc& all) {
  std::vector<EffectVariant> effects(fit.hypothesis.effects().begin(), fit.hypothesis.effects().end());
  effects.push_back(variant_at(effect, all));
  const Hypothesis everywhere(campaign, effects);
  std::vector<double> x = fit.x;
  x.push_back(0.0);
  const std::vector<double> at = everywhere.predict(model, x);
  x.back() = kProbe;
  const std::vector<double> weaker = everywhere.predict(model, x);
  const double scale = everywhere.parameters().back().std / kProbe;
  Eigen::VectorXd response = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(at.size()));
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double d = scale * (weaker[i] - at[i]);
    response[static_cast<Eigen::Index>(i)] = std::isfinite(d) ? d : 0.0;
  }
  return response;
}

// A response in every window times the share of its stations that lie in the disc.
Eigen::VectorXd inside(Eigen::VectorXd response, const WindowModel& model, const sim::Disc& disc) {
  const auto windows = model.windows();
  for (std::size_t v = 0; v < windows.size(); ++v) {
    double share = 0.0;
    for (const Pose2& pose : windows[v].stations)
      if (std::hypot(pose.x_m - disc.x_m, pose.y_m - disc.y_m) < disc.radius_m)
        share += 1.0 / static_cast<double>(windows[v].stations.size());
    response.segment(static_cast<Eigen::Index>(model.offset(v)),
                     static_cast<Eigen::Index>(windows[v].observations.size())) *= share;
  }
  return response;
}

// The disc's neighbours in turn: to either side along x, along y, larger and smaller.
sim::Disc neighbour(sim::Disc disc, int which, double move) {
  const double shift = move * disc.radius_m * (which % 2 == 0 ? 1.0 : -1.0);
  if (which / 2 == 0) disc.x_m += shift;
  if (which / 2 == 1) disc.y_m += shift;
  if (which / 2 == 2) disc.radius_m += kResize * shift;
  return disc;
}

}  // namespace

std::vector<sim::Disc> best_apart(std::vector<ScoredDisc> discs, std::size_t most) {
  std::stable_sort(discs.begin(), discs.end(),
                   [](const ScoredDisc& a, const ScoredDisc& b) { return a.gain > b.gain; });
  std::vector<sim::Disc> kept;
  for (const ScoredDisc& scored : discs) {
    if (kept.size() >= most) break;
    if (std::any_of(kept.begin(), kept.end(), [&](const sim::Disc& k) { return overlap(k, scored.disc); }))
      continue;
    kept.push_back(scored.disc);
  }
  return kept;
}

PatchSearch search_soft_patches(const sim::Effect& effect, const DriveCampaign& campaign,
                                const WindowModel& model, const NoiseModel& noise,
                                const FittedExplanation& fit, const SoftPatchOptions& options) {
  PatchSearch search;
  const auto windows = model.windows();
  const std::optional<sim::Disc> all = whole_map(windows);
  if (!all) return search;
  const Eigen::VectorXd response = weaker_everywhere(campaign, model, fit, effect, *all);
  const LinearProblem linear = linear_problem(fit);
  const KnownColumns fitted(linear.residuals, linear.columns);
  std::vector<ScoredDisc> discs;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    if (model.cancelled()) return search;
    if (!model.used(w)) continue;
    const Pose2& centre = windows[w].middle();
    for (const double radius_m : options.radii_m) {
      const sim::Disc disc{centre.x_m, centre.y_m, radius_m};
      const Eigen::VectorXd white =
          fit.row_weights.asDiagonal() * noise.whiten(inside(response, model, disc));
      const KnownColumns::Equations weaker = fitted.beside(white);
      // Soil can only be weaker.
      if (weaker.products[0] > 0.0) discs.push_back({disc, gain_of(weaker)});
    }
  }
  for (const sim::Disc& disc : best_apart(std::move(discs), static_cast<std::size_t>(options.max_patches)))
    search.variants.push_back(variant_at(effect, disc));
  search.looks = std::max<std::size_t>(windows.size(), 1);
  return search;
}

std::optional<std::size_t> placed_effect(const FittedExplanation& fit) {
  const auto effects = fit.hypothesis.effects();
  for (std::size_t e = 0; e < effects.size(); ++e)
    if (place_of(effects[e])) return e;
  return std::nullopt;
}

FittedExplanation refine_soft_patch(const DriveCampaign& campaign, const WindowModel& model,
                                    const NoiseModel& noise, FittedExplanation fit, const FitOptions& options,
                                    const SoftPatchOptions& patch_options, std::size_t threads) {
  const std::optional<std::size_t> placed = placed_effect(fit);
  if (!placed) return fit;
  const std::size_t which = *placed;
  const sim::Effect& effect = *sim::find_effect(fit.hypothesis.effects()[which].effect);
  FitOptions quick = options;
  quick.max_iterations = kMaxIterations;
  const auto disc = [&] { return *place_of(fit.hypothesis.effects()[which]); };
  // Whether it is better there.
  const auto taken = [&](const sim::Disc& there) {
    std::vector<EffectVariant> moved(fit.hypothesis.effects().begin(), fit.hypothesis.effects().end());
    moved[which] = variant_at(effect, there);
    const double must_reach = fit.log_evidence + patch_options.min_rise;
    FittedExplanation trial =
        fit_explanation(Hypothesis(campaign, moved), model, noise,
                        {fit.x, fit.x, fit.residuals, fit.jacobian}, quick, threads, {}, must_reach);
    if (trial.log_evidence <= must_reach) return false;
    fit = std::move(trial);
    return true;
  };
  // By derivatives a small disc of much weaker soil and a large one of a little weaker soil look alike.
  for (const double radius_m : patch_options.radii_m) {
    if (model.cancelled()) return fit;
    if (radius_m != disc().radius_m) taken({disc().x_m, disc().y_m, radius_m});
  }
  for (const double move : kMoves) {
    for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
      bool better = false;
      for (int k = 0; k < 6; ++k) {
        if (model.cancelled()) return fit;
        better = taken(neighbour(disc(), k, move)) || better;
      }
      if (!better) break;
    }
  }
  return fit;
}

}  // namespace slipway::gap
