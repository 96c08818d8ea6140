#include "gap/diagnosis/search/soft_patch_search.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "sim/effects/effect_catalogue.h"

namespace slipway::gap {
namespace {

constexpr std::array kRadii_m{0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0};
constexpr double kWholeMap_m = 1000.0;

struct Disc {
  double x_m, y_m, radius_m, gain;
};

bool alike(const Disc& a, const Disc& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m) < 0.5 * (a.radius_m + b.radius_m);
}

}  // namespace

PatchSearch search_soft_patches(const sim::Effect& effect, const DriveCampaign& campaign,
                                const WindowModel& model, const NoiseModel& noise,
                                const FittedExplanation& fit, std::size_t most) {
  PatchSearch search;
  const auto windows = model.windows();
  double x_m = 0.0, y_m = 0.0;
  std::size_t count = 0;
  for (const DriveWindow& w : windows)
    for (const Pose2& pose : w.stations) {
      x_m += pose.x_m;
      y_m += pose.y_m;
      ++count;
    }
  if (count == 0) return search;
  // What weaker soil everywhere would do, window by window.
  const Hypothesis everywhere(
      campaign, {variant_at(effect, {x_m / static_cast<double>(count), y_m / static_cast<double>(count),
                                     kWholeMap_m})});
  std::vector<double> x(fit.x.begin(),
                        fit.x.begin() + static_cast<std::ptrdiff_t>(everywhere.nuisance_count()));
  x.push_back(0.0);
  const std::vector<double> at = everywhere.predict(model, x);
  x.back() = 0.1;
  const std::vector<double> weaker = everywhere.predict(model, x);
  const double scale = everywhere.parameters().back().std / 0.1;
  Eigen::VectorXd response = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(at.size()));
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double d = scale * (weaker[i] - at[i]);
    response[static_cast<Eigen::Index>(i)] = std::isfinite(d) ? d : 0.0;
  }
  const Eigen::MatrixXd& known = fit.white_jacobian;
  Eigen::MatrixXd hessian = known.transpose() * known;
  hessian.diagonal().array() += 1.0;
  const Eigen::LLT<Eigen::MatrixXd> llt(hessian);
  const Eigen::VectorXd solved = llt.solve(known.transpose() * fit.white_linear);
  const Eigen::VectorXd left = fit.white_linear - known * solved;

  std::vector<Disc> discs;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    if (model.cancelled()) return search;
    if (!model.used(w)) continue;
    const Pose2& centre = windows[w].stations[windows[w].stations.size() / 2];
    for (const double radius_m : kRadii_m) {
      Eigen::VectorXd column = response;
      for (std::size_t v = 0; v < windows.size(); ++v) {
        double inside = 0.0;
        for (const Pose2& pose : windows[v].stations)
          if (std::hypot(pose.x_m - centre.x_m, pose.y_m - centre.y_m) < radius_m)
            inside += 1.0 / static_cast<double>(windows[v].stations.size());
        column.segment(static_cast<Eigen::Index>(model.offset(v)),
                       static_cast<Eigen::Index>(windows[v].observations.size())) *= inside;
      }
      const Eigen::VectorXd white = fit.row_weights.asDiagonal() * noise.whiten(column);
      const Eigen::VectorXd crossed = known.transpose() * white;
      const double information = white.squaredNorm() - crossed.dot(llt.solve(crossed));
      const double score = white.dot(left);
      if (score <= 0.0) continue;  // soil can only be weaker
      discs.push_back({centre.x_m, centre.y_m, radius_m,
                       0.5 * score * score / (1.0 + information) - 0.5 * std::log1p(information)});
    }
  }
  std::stable_sort(discs.begin(), discs.end(), [](const Disc& a, const Disc& b) { return a.gain > b.gain; });
  std::vector<Disc> kept;
  for (const Disc& disc : discs) {
    if (kept.size() >= most) break;
    if (std::any_of(kept.begin(), kept.end(), [&](const Disc& k) { return alike(k, disc); })) continue;
    kept.push_back(disc);
    search.variants.push_back(variant_at(effect, {disc.x_m, disc.y_m, disc.radius_m}));
  }
  search.looks = std::max<std::size_t>(windows.size(), 1);
  return search;
}

FittedExplanation refine_soft_patch(const DriveCampaign& campaign, const WindowModel& model,
                                    const NoiseModel& noise, FittedExplanation fit,
                                    const ExplanationOptions& options) {
  std::size_t which = 0;
  const auto effects = fit.hypothesis.effects();
  while (which < effects.size() && !place_of(effects[which])) ++which;
  if (which == effects.size()) return fit;
  const sim::Effect& effect = *sim::find_effect(effects[which].effect);
  ExplanationOptions quick = options;
  quick.iterations = 3;
  for (const double step : {0.5, 0.25}) {
    for (int sweep = 0; sweep < 3; ++sweep) {
      bool better = false;
      for (int k = 0; k < 6; ++k) {
        if (model.cancelled()) return fit;
        std::vector<EffectVariant> moved(fit.hypothesis.effects().begin(), fit.hypothesis.effects().end());
        sim::Disc place = *place_of(moved[which]);
        const double shift = step * place.radius_m * (k % 2 == 0 ? 1.0 : -1.0);
        if (k / 2 == 0) place.x_m += shift;
        if (k / 2 == 1) place.y_m += shift;
        if (k / 2 == 2) place.radius_m += 0.6 * shift;
        moved[which] = variant_at(effect, place);
        FittedExplanation trial = fit_explanation(Hypothesis(campaign, moved), model, noise, fit.x, quick);
        if (trial.log_evidence <= fit.log_evidence + 0.1) continue;
        fit = std::move(trial);
        better = true;
      }
      if (!better) break;
    }
  }
  return fit;
}

}  // namespace slipway::gap
