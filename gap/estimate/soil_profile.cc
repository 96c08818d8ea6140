#include "gap/estimate/soil_profile.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/normal_interval.h"

namespace slipway::gap {
namespace {

class Profile {
 public:
  Profile(std::span<const Unknown> unknowns, std::size_t profiled, std::size_t residual_count,
          const ResidualFunction& residuals, const ProfileOptions& options, Progress& progress)
      : unknowns_(unknowns.begin(), unknowns.end()),
        profiled_(profiled),
        residual_count_(residual_count),
        residuals_(residuals),
        options_(options),
        progress_(progress) {
    unknowns_[profiled_].prior.reset();
  }

  // The least cost over all unknowns, and where.
  std::optional<double> settle(std::vector<double>& x) {
    std::vector<Unknown> unknowns = unknowns_;
    for (std::size_t k = 0; k < x.size(); ++k) unknowns[k].start = x[k];
    const auto fit = fit_least_squares(unknowns, residual_count_, residuals_, options_.fit, progress_);
    if (!fit) return std::nullopt;
    x = fit->estimate;
    return fit->cost;
  }

  // The least cost with the profiled unknown held at x[profiled]; the others are refitted in place.
  std::optional<double> cost_at(std::vector<double>& x) {
    std::vector<Unknown> others;
    std::vector<double> all = x;
    for (std::size_t k = 0; k < unknowns_.size(); ++k)
      if (k != profiled_) {
        others.push_back(unknowns_[k]);
        others.back().start = std::clamp(x[k], unknowns_[k].lowest, unknowns_[k].highest);
      }
    const auto spread = [&](std::span<const double> free) {
      for (std::size_t k = 0, i = 0; k < all.size(); ++k)
        if (k != profiled_) all[k] = free[i++];
    };
    if (others.empty()) {
      std::vector<double> r(residual_count_);
      return fit_held(all, r);
    }
    const ResidualFunction held = [&](std::span<const double> free, std::span<double> r) {
      spread(free);
      return residuals_(all, r);
    };
    const auto fit = fit_least_squares(others, residual_count_, held, options_.fit, progress_);
    if (!fit) return std::nullopt;
    spread(fit->estimate);
    x = all;
    return fit->cost;
  }

  // How far from `at` towards `bound` the cost rises by options.rise; the bound where it doesn't.
  double end(const std::vector<double>& at, double least, double first_step, double bound, bool& open) {
    const double centre = at[profiled_], room = std::abs(bound - centre);
    const double sign = bound > centre ? 1.0 : -1.0;
    double inside = 0.0, outside = room, step = std::min(first_step, room);
    std::optional<double> rise_inside = 0.0, rise_outside;
    std::vector<double> x = at;
    constexpr int kMaxRefits = 7;
    for (int refit = 0; refit < kMaxRefits && room > 0.0 && !progress_.cancelled(); ++refit) {
      // The others go along as they went so far.
      std::vector<double> there = x;
      const double gone = std::abs(x[profiled_] - centre);
      for (std::size_t k = 0; k < there.size() && gone > 0.0; ++k)
        there[k] = at[k] + (x[k] - at[k]) * (step / gone);
      there[profiled_] = step >= room ? bound : centre + sign * step;
      const auto cost = cost_at(there);
      const double rise = cost ? *cost - least : 1e3 * options_.rise;
      if (rise <= options_.rise) {
        inside = step;
        rise_inside = std::max(rise, 0.0);
        x = there;
        if (step >= room) {
          open = true;
          return bound;
        }
      } else {
        outside = step;
        rise_outside = rise;
      }
      if (std::abs(rise / options_.rise - 1.0) < kClose) break;
      // The root of the cost's rise is close to a straight line in the distance.
      if (rise_outside) {
        const double a = std::sqrt(*rise_inside), b = std::sqrt(*rise_outside), t = std::sqrt(options_.rise);
        const double share = std::clamp((t - a) / std::max(b - a, 1e-12), 0.05, 0.95);
        step = inside + share * (outside - inside);
      } else {
        const double grow = std::sqrt(options_.rise / std::max(rise, 1e-3 * options_.rise));
        step = std::min(room, inside * std::clamp(1.03 * grow, 1.1, 10.0));
      }
    }
    open = room == 0.0 || (!rise_outside && inside >= room);
    return centre + sign * (rise_outside ? crossing(inside, *rise_inside, outside, *rise_outside) : inside);
  }

 private:
  static constexpr double kClose = 0.03;

  double crossing(double inside, double rise_inside, double outside, double rise_outside) const {
    const double a = std::sqrt(rise_inside), b = std::sqrt(rise_outside), t = std::sqrt(options_.rise);
    return inside + std::clamp((t - a) / std::max(b - a, 1e-12), 0.0, 1.0) * (outside - inside);
  }
  // The cost where there is nothing else to fit: RobustLoss of the residuals alone.
  std::optional<double> fit_held(const std::vector<double>& x, std::vector<double>& r) {
    if (!residuals_(x, r)) return std::nullopt;
    double cost = 0.0;
    const double s = options_.fit.loss_scale;
    for (const double v : r) {
      const double a = std::abs(v);
      if (options_.fit.loss == RobustLoss::kHuber && a > s)
        cost += s * (a - 0.5 * s);
      else if (options_.fit.loss == RobustLoss::kCauchy)
        cost += 0.5 * s * s * std::log1p(a * a / (s * s));
      else
        cost += 0.5 * a * a;
    }
    return cost;
  }

  std::vector<Unknown> unknowns_;
  std::size_t profiled_;
  std::size_t residual_count_;
  const ResidualFunction& residuals_;
  const ProfileOptions& options_;
  Progress& progress_;
};

}  // namespace

Result<ProfileInterval> profile_interval(std::span<const Unknown> unknowns, std::size_t profiled,
                                         std::size_t residual_count, const ResidualFunction& residuals,
                                         std::span<const double> around, double deviation,
                                         const ProfileOptions& options, Progress& progress) {
  Profile profile(unknowns, profiled, residual_count, residuals, options, progress);
  std::vector<double> at(around.begin(), around.end());
  const auto least = profile.settle(at);
  const Unknown& u = unknowns[profiled];
  ProfileInterval interval{u.lowest, u.highest, true, true};
  if (least) {
    const double step = kReach90 * (deviation > 0.0 ? deviation : u.step_scale);
    interval.low = profile.end(at, *least, step, u.lowest, interval.low_open);
    interval.high = profile.end(at, *least, step, u.highest, interval.high_open);
  }
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the estimate was given up");
  return interval;
}

}  // namespace slipway::gap
