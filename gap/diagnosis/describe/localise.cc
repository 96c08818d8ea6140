#include "gap/diagnosis/describe/localise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "core/angle.h"
#include "core/random.h"
#include "gap/diagnosis/describe/regimes.h"
#include "gap/diagnosis/describe/slices.h"

namespace slipway::gap {
namespace {

constexpr int kFunctions = 5;

std::array<double, kFunctions> functions_of(const WindowVariables& v) {
  return {1.0, v.slope_deg / 10.0, std::clamp(v.slip, -1.0, 1.0), v.speed_m_s < 0.0 ? -1.0 : 1.0,
          v.temperature_c / 30.0};
}

// Of each window and channel: the mean square of residuals in deviations.
std::vector<double> squares_of(const PreparedCampaign& prepared, const Eigen::VectorXd& residuals,
                               Channel channel) {
  std::vector<double> squares(prepared.windows.size(), 0.0);
  for (std::size_t w = 0; w < squares.size(); ++w) {
    int count = 0;
    for (std::size_t i = 0; i < prepared.windows[w].observations.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(prepared.model->offset(w) + i);
      const double deviation = prepared.noise->deviation()[row];
      if (prepared.windows[w].observations[i].channel != channel || deviation <= 0.0) continue;
      if (!std::isfinite(residuals[row])) continue;
      squares[w] += std::pow(residuals[row] / deviation, 2);
      ++count;
    }
    if (count > 0) squares[w] /= count;
  }
  return squares;
}

std::vector<ChannelSquares> channel_squares(const PreparedCampaign& prepared,
                                            const Eigen::VectorXd& residuals) {
  std::vector<ChannelSquares> all;
  for (std::size_t c = 0; c < channel_count(); ++c)
    all.push_back({static_cast<Channel>(c), squares_of(prepared, residuals, static_cast<Channel>(c))});
  return all;
}

std::vector<std::size_t> drives_of(const PreparedCampaign& prepared) {
  std::vector<std::size_t> drives;
  for (const DriveWindow& window : prepared.windows) drives.push_back(window.drive);
  return drives;
}

}  // namespace

std::vector<WindowVariables> window_variables(const PreparedCampaign& prepared,
                                              const DriveCampaign& campaign) {
  std::vector<WindowVariables> all;
  for (std::size_t w = 0; w < prepared.windows.size(); ++w) {
    const DriveWindow& window = prepared.windows[w];
    const WindowModel::Conditions& at = prepared.model->conditions(w);
    WindowVariables v;
    v.slope_deg = deg_from_rad(at.pitch_rad);
    v.cross_slope_deg = deg_from_rad(at.roll_rad);
    for (const Observation& o : window.observations)
      if (o.channel == Channel::kSlip) v.slip = o.value;
    v.turning = window.command.turn_in_place ? 1.0 : 0.0;
    v.speed_m_s = window.command.turn_in_place ? 0.0 : window.command.speed_m_s;
    v.curvature_1_m = window.command.turn_in_place ? 0.0 : window.command.curvature_1_m;
    v.temperature_c = window.command.motor_temp_c.value_or(campaign.rover->drive.reference_temp_c);
    v.time_s = window.mid_s() - campaign.drives[window.drive].samples.front().time_s;
    all.push_back(v);
  }
  return all;
}

std::vector<ChannelGap> channel_gaps(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                     const Eigen::VectorXd& residuals, const DiagnosisOptions& options) {
  struct Group {
    Channel channel;
    int wheel;
    double square = 0.0, noise = 0.0, sum = 0.0;
    int count = 0;
    std::map<std::size_t, std::array<double, kFunctions>> drives;  // sums of residual times function
  };
  const std::vector<WindowVariables> variables = window_variables(prepared, campaign);
  std::map<std::pair<int, int>, Group> groups;
  for (std::size_t w = 0; w < prepared.windows.size(); ++w) {
    for (std::size_t i = 0; i < prepared.windows[w].observations.size(); ++i) {
      const Observation& o = prepared.windows[w].observations[i];
      const auto row = static_cast<Eigen::Index>(prepared.model->offset(w) + i);
      const double deviation = prepared.noise->deviation()[row];
      if (deviation <= 0.0 || !std::isfinite(residuals[row])) continue;
      if (prepared.windows[w].censored && o.channel == Channel::kSlip) continue;
      Group& g =
          groups
              .try_emplace({static_cast<int>(o.channel), o.wheel}, Group{o.channel, o.wheel, 0, 0, 0, 0, {}})
              .first->second;
      g.square += residuals[row] * residuals[row];
      g.noise += deviation * deviation;
      g.sum += residuals[row];
      ++g.count;
      const auto f = functions_of(variables[w]);
      auto& sums = g.drives[prepared.windows[w].drive];
      for (int k = 0; k < kFunctions; ++k) sums[k] += residuals[row] / deviation * f[k];
    }
  }
  // |t| of each group's sums over drives, with the drives' signs as given.
  const auto largest_t = [](const Group& g, const auto& sign) {
    double most = 0.0;
    for (int k = 0; k < kFunctions; ++k) {
      double sum = 0.0, square = 0.0;
      for (const auto& [drive, sums] : g.drives) {
        sum += sign(drive) * sums[k];
        square += sums[k] * sums[k];
      }
      if (square > 0.0) most = std::max(most, std::abs(sum) / std::sqrt(square));
    }
    return most;
  };
  std::vector<double> flipped(static_cast<std::size_t>(options.resamples), 0.0);
  for (std::size_t b = 0; b < flipped.size(); ++b) {
    if (prepared.model->cancelled()) return {};
    const std::uint64_t key = random_key(options.seed, 1000 + b);
    const auto sign = [key](std::size_t drive) { return random_uniform(key, drive) < 0.5 ? -1.0 : 1.0; };
    for (const auto& [name, g] : groups) flipped[b] = std::max(flipped[b], largest_t(g, sign));
  }
  std::vector<ChannelGap> gaps;
  for (const auto& [name, g] : groups) {
    ChannelGap gap;
    gap.channel = g.channel;
    if (g.wheel >= 0) gap.wheel = campaign.rover->wheels[static_cast<std::size_t>(g.wheel)].name;
    gap.gap = std::sqrt(g.square / g.count);
    gap.noise = std::sqrt(g.noise / g.count);
    gap.bias = g.sum / g.count;
    const double t = largest_t(g, [](std::size_t) { return 1.0; });
    const auto above = std::count_if(flipped.begin(), flipped.end(), [t](double f) { return f >= t; });
    gap.significance = (1.0 + static_cast<double>(above)) / (1.0 + static_cast<double>(flipped.size()));
    gaps.push_back(gap);
  }
  return gaps;
}

std::vector<Regime> regimes_of(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                               const Eigen::VectorXd& residuals, LookedAt looked_at,
                               const DiagnosisOptions& options, std::size_t most) {
  const std::vector<Slice> slices = slices_of(window_variables(prepared, campaign));
  return regimes_in(slices, channel_squares(prepared, residuals), drives_of(prepared), looked_at, options,
                    most, [&] { return prepared.model->cancelled(); });
}

std::vector<ChannelShare> channel_shares(const PreparedCampaign& prepared, const Eigen::VectorXd& residuals) {
  return shares_of(channel_squares(prepared, residuals));
}

std::vector<GapPlace> gap_places(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                 const Eigen::VectorXd& residuals, const DiagnosisOptions& options) {
  constexpr std::array kRadii_m{1.5, 3.0};
  struct Disc {
    GapPlace place;
    double excess = 0.0;
    Slice slice;
  };
  std::vector<Disc> found;
  const std::vector<std::size_t> drive_of = drives_of(prepared);
  for (std::size_t c = 0; c < channel_count(); ++c) {
    const auto channel = static_cast<Channel>(c);
    if (!row_of(channel).located) continue;
    const std::vector<double> squares = squares_of(prepared, residuals, channel);
    const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
    const Excess excess(squares);
    if (excess.variance() <= 0.0 || excess.mean() < 1.0) continue;
    std::vector<Disc> discs;
    for (std::size_t w = 0; w < prepared.windows.size(); ++w) {
      if (!prepared.model->used(w)) continue;
      const std::size_t terrain = campaign.drives[prepared.windows[w].drive].terrain;
      const Pose2& centre = prepared.windows[w].stations[prepared.windows[w].stations.size() / 2];
      for (const double radius_m : kRadii_m) {
        Disc disc{{campaign.terrains[terrain].name, centre.x_m, centre.y_m, radius_m, channel, 0.0}, 0.0, {}};
        std::set<std::size_t> drives;
        for (std::size_t v = 0; v < prepared.windows.size(); ++v) {
          const Pose2& at = prepared.windows[v].stations[prepared.windows[v].stations.size() / 2];
          if (campaign.drives[prepared.windows[v].drive].terrain != terrain ||
              std::hypot(at.x_m - centre.x_m, at.y_m - centre.y_m) > radius_m)
            continue;
          disc.slice.windows.push_back(v);
          drives.insert(prepared.windows[v].drive);
          disc.place.share_of_gap += squares[v] / sum;
        }
        // A place is one that several drives met, and that is not where they all are.
        if (disc.slice.windows.size() < 3 || drives.size() < 2 ||
            3 * disc.slice.windows.size() > squares.size())
          continue;
        disc.excess = excess(squares, disc.slice);
        discs.push_back(std::move(disc));
      }
    }
    std::vector<double> by_chance(static_cast<std::size_t>(options.resamples) / 4 + 1, 0.0);
    for (std::size_t b = 0; b < by_chance.size(); ++b) {
      if (prepared.model->cancelled()) return {};
      std::vector<double> permuted;
      for (const std::size_t w : reordered(drive_of, random_key(options.seed, 9000 + b)))
        permuted.push_back(squares[w]);
      for (const Disc& disc : discs) by_chance[b] = std::max(by_chance[b], excess(permuted, disc.slice));
    }
    for (Disc& disc : discs) {
      const auto above =
          std::count_if(by_chance.begin(), by_chance.end(), [&](double x) { return x >= disc.excess; });
      if ((1.0 + static_cast<double>(above)) / (1.0 + static_cast<double>(by_chance.size())) < 0.05)
        found.push_back(std::move(disc));
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Disc& a, const Disc& b) { return a.excess > b.excess; });
  std::vector<GapPlace> places;
  for (const Disc& disc : found) {
    if (places.size() >= 5) break;
    if (std::any_of(places.begin(), places.end(), [&](const GapPlace& p) {
          return p.terrain == disc.place.terrain &&
                 std::hypot(p.x_m - disc.place.x_m, p.y_m - disc.place.y_m) <
                     p.radius_m + disc.place.radius_m;
        }))
      continue;
    places.push_back(disc.place);
  }
  return places;
}

}  // namespace slipway::gap
