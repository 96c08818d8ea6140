#include "gap/diagnosis/model/difference_columns.h"

#include <array>
#include <cmath>
#include <string>

#include "sim/effects/multipass.h"

namespace slipway::gap {
namespace {

// What tracks are taken to be: parameters of `multipass`.
struct Tracks {
  double stiffening, strengthening;
};
constexpr std::array<Tracks, 3> kTracks{{{0.4, 0.0}, {1.6, 0.0}, {1.6, 0.15}}};

// What such tracks change; 0 where either has no answer.
Eigen::VectorXd track_column(const WindowModel& model, std::span<const double> x,
                             std::span<const double> expected, const Tracks& tracks, std::size_t threads) {
  const EffectVariant in_tracks{
      .effect = std::string(sim::kMultipass.name),
      .fixed = {{"stiffening", tracks.stiffening}, {"strengthening", tracks.strengthening}}};
  const Hypothesis hypothesis(model.campaign(), {in_tracks});
  const std::vector<double> changed = hypothesis.predict(model, x, threads);
  Eigen::VectorXd column(static_cast<Eigen::Index>(expected.size()));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double change = changed[i] - expected[i];
    column[static_cast<Eigen::Index>(i)] = std::isfinite(change) ? change : 0.0;
  }
  return column;
}

}  // namespace

Eigen::MatrixXd difference_columns(const WindowModel& model, std::span<const double> x,
                                   std::span<const double> expected, const SmoothScale& scale,
                                   std::size_t threads) {
  const Eigen::MatrixXd smooth = smooth_columns(model, expected, scale);
  const auto of_tracks = static_cast<Eigen::Index>(kTracks.size() * channel_count());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(smooth.rows(), smooth.cols() + of_tracks);
  columns.leftCols(smooth.cols()) = smooth;
  for (std::size_t s = 0; s < kTracks.size(); ++s) {
    const Eigen::VectorXd changed = track_column(model, x, expected, kTracks[s], threads);
    Eigen::Index row = 0;
    for (const DriveWindow& window : model.windows())
      for (const Observation& o : window.observations) {
        const std::size_t at = kTracks.size() * static_cast<std::size_t>(o.channel) + s;
        columns(row, smooth.cols() + static_cast<Eigen::Index>(at)) = changed[row];
        ++row;
      }
  }
  return columns;
}

std::vector<std::size_t> difference_groups(const sim::RoverModel& rover) {
  std::vector<std::size_t> groups = smooth_groups(rover);
  for (std::size_t c = 0; c < channel_count(); ++c)
    groups.insert(groups.end(), kTracks.size(), kSmoothGroups * channel_count() + c);
  return groups;
}

}  // namespace slipway::gap
