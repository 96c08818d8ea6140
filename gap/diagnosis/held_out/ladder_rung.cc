#include "gap/diagnosis/held_out/ladder_rung.h"

#include <cmath>

#include "core/quantile.h"

namespace slipway::gap {
namespace {

// Sums of squares and their number, of each group of drives.
struct GroupSquares {
  std::vector<double> squares, count;

  double rms(std::span<const std::size_t> groups) const {
    double sum = 0.0, of = 0.0;
    for (const std::size_t g : groups) {
      sum += squares[g];
      of += count[g];
    }
    return of > 0.0 ? std::sqrt(sum / of) : 0.0;
  }
};

GroupSquares squares_of(const PreparedCampaign& prepared, Channel channel, const Eigen::VectorXd& residuals,
                        const DriveResampling& drives) {
  GroupSquares sums{std::vector<double>(drives.group_count, 0.0),
                    std::vector<double>(drives.group_count, 0.0)};
  for (std::size_t w = 0; w < prepared.windows.size(); ++w) {
    const DriveWindow& window = prepared.windows[w];
    for (std::size_t i = 0; i < window.observations.size(); ++i) {
      const double r = residuals[static_cast<Eigen::Index>(prepared.model->offset(w) + i)];
      if (window.observations[i].channel != channel || !std::isfinite(r)) continue;
      sums.squares[drives.groups[window.drive]] += r * r;
      sums.count[drives.groups[window.drive]] += 1.0;
    }
  }
  return sums;
}

}  // namespace

void add_discrepancy_rung(const PreparedCampaign& prepared, const LinearHeldOut& held_out,
                          const FittedExplanation& fit, const DriveResampling& drives,
                          const DiscrepancyOptions& options, std::vector<ChannelClosure>& channels) {
  const DiscrepancyTerm& term = prepared.discrepancy;
  if (term.values.cols() == 0) return;
  std::vector<double> sizes;
  for (const double share : options.imprecision_shares) sizes.push_back(share * options.imprecision);
  sizes.insert(sizes.end(), options.sizes.begin(), options.sizes.end());
  const double size = most_probable_size(fit, whitened(fit, *prepared.noise, term), sizes,
                                         [&] { return prepared.model->cancelled(); });
  const Eigen::VectorXd residuals = held_out.residuals(fit, size * term.values);
  std::vector<std::size_t> every;
  for (std::size_t g = 0; g < drives.group_count; ++g) every.push_back(g);
  for (ChannelClosure& channel : channels) {
    const GroupSquares sums = squares_of(prepared, channel.channel, residuals, drives);
    std::vector<double> resampled;
    for (const std::vector<std::size_t>& groups : drives.resamples) resampled.push_back(sums.rms(groups));
    channel.with_discrepancy =
        Interval{sums.rms(every), quantile(resampled, 0.05), quantile(std::move(resampled), 0.95)};
  }
}

}  // namespace slipway::gap
