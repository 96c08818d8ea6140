#include "gap/diagnosis/search/like_drives.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/angle.h"

namespace slipway::gap {
namespace {

// Half a window's length, and how far a rover turns on the sharpest of arcs along it.
constexpr double kSamePlace_m = 0.75, kSameHeading_rad = 0.2;
constexpr double kSameCommand = 1e-3;  // m/s, 1/m, rad/s or rad
constexpr int kFewestPairs = 8;        // of windows, from which a channel's regression is known

bool same_command(const sim::DriveCommand& a, const sim::DriveCommand& b) {
  const auto same = [](double x, double y) { return std::abs(x - y) < kSameCommand; };
  if (a.turn_in_place || b.turn_in_place)
    return a.turn_in_place == b.turn_in_place && same(a.turn_rate_rad_s, b.turn_rate_rad_s);
  return same(a.speed_m_s, b.speed_m_s) && same(a.curvature_1_m, b.curvature_1_m) &&
         same(a.crab_rad, b.crab_rad);
}

// The nearest window of the same command at the same place; null where there is none.
const SeenWindow* like_window(const std::vector<SeenWindow>& seen, const std::string& terrain,
                              const DriveWindow& window) {
  const Pose2& at = window.middle();
  const SeenWindow* nearest = nullptr;
  double least = kSamePlace_m;
  for (const SeenWindow& other : seen) {
    const double apart = std::hypot(other.middle.x_m - at.x_m, other.middle.y_m - at.y_m);
    if (apart >= least || other.terrain != terrain || !same_command(other.command, window.command) ||
        std::abs(wrapped_rad(other.middle.yaw_rad - at.yaw_rad)) > kSameHeading_rad)
      continue;
    least = apart;
    nearest = &other;
  }
  return nearest;
}

struct Pair {
  Eigen::Index row = 0;
  double seen = 0.0;
};

}  // namespace

std::vector<SeenWindow> seen_windows(const WindowModel& reference, const Eigen::VectorXd& residuals) {
  const DriveCampaign& campaign = reference.campaign();
  std::vector<SeenWindow> seen;
  for (std::size_t w = 0; w < reference.windows().size(); ++w) {
    if (!reference.used(w)) continue;
    const DriveWindow& window = reference.windows()[w];
    SeenWindow& of = seen.emplace_back();
    of.terrain = campaign.terrains[campaign.drives[window.drive].terrain].name;
    of.middle = window.middle();
    of.command = window.command;
    for (std::size_t i = 0; i < window.observations.size(); ++i) {
      const double left = residuals[static_cast<Eigen::Index>(reference.offset(w) + i)];
      if (std::isfinite(left) && !window.censored)
        of.left_over[{window.observations[i].channel, window.observations[i].wheel}] = left;
    }
  }
  return seen;
}

Eigen::VectorXd repeated_part(const std::vector<SeenWindow>& seen, const WindowModel& model,
                              const Eigen::VectorXd& residuals) {
  const DriveCampaign& campaign = model.campaign();
  std::map<std::pair<Channel, int>, std::vector<Pair>> pairs;
  for (std::size_t w = 0; w < model.windows().size(); ++w) {
    const DriveWindow& window = model.windows()[w];
    if (!model.used(w) || window.censored) continue;
    const SeenWindow* const like =
        like_window(seen, campaign.terrains[campaign.drives[window.drive].terrain].name, window);
    if (like == nullptr) continue;
    for (std::size_t i = 0; i < window.observations.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(model.offset(w) + i);
      const std::pair channel{window.observations[i].channel, window.observations[i].wheel};
      const auto left = like->left_over.find(channel);
      if (left != like->left_over.end() && std::isfinite(residuals[row]))
        pairs[channel].push_back({row, left->second});
    }
  }
  Eigen::VectorXd repeated = Eigen::VectorXd::Zero(residuals.size());
  for (const auto& [channel, of] : pairs) {
    const auto count = static_cast<double>(of.size());
    if (count < kFewestPairs) continue;
    double mean = 0.0, mean_seen = 0.0, product = 0.0, square = 0.0;
    for (const Pair& pair : of) {
      mean += residuals[pair.row] / count;
      mean_seen += pair.seen / count;
    }
    for (const Pair& pair : of) {
      product += (residuals[pair.row] - mean) * (pair.seen - mean_seen);
      square += (pair.seen - mean_seen) * (pair.seen - mean_seen);
    }
    const double part = square > 0.0 ? std::clamp(product / square, 0.0, 1.0) : 0.0;
    for (const Pair& pair : of) repeated[pair.row] = mean_seen + part * (pair.seen - mean_seen);
  }
  return repeated;
}

}  // namespace slipway::gap
