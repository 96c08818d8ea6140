#include "gap/diagnosis/model/difference_columns.h"

#include <array>
#include <cmath>
#include <string>

#include "sim/effects/multipass.h"

namespace slipway::gap {
namespace {

// How many times stiffer than fresh soil tracks are taken to be, less 1. A third column, of tracks that are
// stronger in shear too, left the reference so much open that healthy drives had a name.
constexpr std::array<double, 2> kStiffenings{0.4, 1.6};

// What tracks so much stiffer change; 0 where either has no answer.
Eigen::VectorXd track_column(const WindowModel& model, std::span<const double> x,
                             std::span<const double> expected, double stiffening, std::size_t threads) {
  const EffectVariant in_tracks{.effect = std::string(sim::kMultipass.name),
                                .fixed = {{"stiffening", stiffening}, {"strengthening", 0.0}}};
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
  const auto of_tracks = static_cast<Eigen::Index>(kStiffenings.size() * channel_count());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(smooth.rows(), smooth.cols() + of_tracks);
  columns.leftCols(smooth.cols()) = smooth;
  for (std::size_t s = 0; s < kStiffenings.size(); ++s) {
    const Eigen::VectorXd changed = track_column(model, x, expected, kStiffenings[s], threads);
    Eigen::Index row = 0;
    for (const DriveWindow& window : model.windows())
      for (const Observation& o : window.observations) {
        const std::size_t at = kStiffenings.size() * static_cast<std::size_t>(o.channel) + s;
        columns(row, smooth.cols() + static_cast<Eigen::Index>(at)) = changed[row];
        ++row;
      }
  }
  return columns;
}

std::vector<std::size_t> difference_groups(const sim::RoverModel& rover) {
  std::vector<std::size_t> groups = smooth_groups(rover);
  for (std::size_t c = 0; c < channel_count(); ++c)
    groups.insert(groups.end(), kStiffenings.size(), kSmoothGroups * channel_count() + c);
  return groups;
}

}  // namespace slipway::gap
