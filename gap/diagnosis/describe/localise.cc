#include "gap/diagnosis/describe/localise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "core/angle.h"
#include "core/random.h"
#include "gap/diagnosis/describe/regimes.h"
#include "gap/diagnosis/describe/slices.h"
#include "gap/diagnosis/search/random_streams.h"

namespace slipway::gap {
namespace {

std::array<double, kBiasFunctions> functions_of(const WindowVariables& v, double predicted,
                                                const LocationOptions& options) {
  return {1.0,
          v.slope_deg / options.slope_scale_deg,
          std::clamp(v.slip, -1.0, 1.0),
          v.speed_m_s < 0.0 ? -1.0 : 1.0,
          v.temperature_c / options.temperature_scale_c,
          predicted};
}

// Of each window: the mean square of a channel's residuals in deviations; NaN where it has no reading.
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
    squares[w] = count > 0 ? squares[w] / count : std::numeric_limits<double>::quiet_NaN();
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

// What a channel of one wheel (or of the rover) has in all windows.
struct ChannelSums {
  Channel channel = Channel::kSlip;
  int wheel = -1;
  double square = 0.0, noise = 0.0, sum = 0.0;
  int count = 0;
};

// By channel and wheel, in their order, with the drives' sums beside.
struct SummedChannels {
  std::vector<ChannelSums> sums;
  std::vector<DriveSums> drives;
};

SummedChannels sum_channels(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                            const Eigen::VectorXd& residuals, const LocationOptions& options) {
  const std::vector<WindowVariables> variables = window_variables(prepared, campaign);
  std::map<std::pair<int, int>, std::pair<ChannelSums, DriveSums>> groups;
  for (std::size_t w = 0; w < prepared.windows.size(); ++w) {
    for (std::size_t i = 0; i < prepared.windows[w].observations.size(); ++i) {
      const Observation& o = prepared.windows[w].observations[i];
      const auto row = static_cast<Eigen::Index>(prepared.model->offset(w) + i);
      const double deviation = prepared.noise->deviation()[row];
      if (deviation <= 0.0 || !std::isfinite(residuals[row])) continue;
      if (prepared.windows[w].censored && o.channel == Channel::kSlip) continue;
      auto& [sums, drives] = groups[{static_cast<int>(o.channel), o.wheel}];
      sums.channel = o.channel;
      sums.wheel = o.wheel;
      sums.square += residuals[row] * residuals[row];
      sums.noise += deviation * deviation;
      sums.sum += residuals[row];
      ++sums.count;
      const auto f = functions_of(variables[w], o.value - residuals[row], options);
      auto& of_drive = drives[prepared.windows[w].drive];
      for (int k = 0; k < kBiasFunctions; ++k) of_drive[k] += residuals[row] / deviation * f[k];
    }
  }
  SummedChannels summed;
  for (auto& [name, group] : groups) {
    summed.sums.push_back(group.first);
    summed.drives.push_back(std::move(group.second));
  }
  return summed;
}

// A disc with the windows in it.
struct FilledDisc {
  FoundPlace place;
  Slice slice;
};

// Nothing where the disc is no place: too few windows or drives, or where most windows are.
std::optional<FilledDisc> filled(std::span<const PlacedWindow> windows, const PlacedWindow& centre,
                                 double radius_m, Channel channel, std::span<const double> squares,
                                 const LocationOptions& options) {
  FilledDisc disc;
  disc.place = {centre.terrain, centre.x_m, centre.y_m, radius_m, 0.0, 0.0, channel};
  std::set<std::size_t> drives;
  for (std::size_t v = 0; v < windows.size(); ++v) {
    const PlacedWindow& at = windows[v];
    if (at.terrain != centre.terrain || std::hypot(at.x_m - centre.x_m, at.y_m - centre.y_m) > radius_m)
      continue;
    disc.slice.windows.push_back(v);
    drives.insert(at.drive);
    disc.place.share += squares[v];
  }
  const std::size_t count = disc.slice.windows.size();
  if (count < static_cast<std::size_t>(options.min_place_windows) ||
      drives.size() < static_cast<std::size_t>(options.min_place_drives) ||
      static_cast<std::size_t>(options.max_place_one_in) * count > windows.size())
    return std::nullopt;
  return disc;
}

// The discs of one channel, in the windows that have a reading of it, and what chance has of the largest.
struct ChannelPlaces {
  std::vector<FilledDisc> discs;
  LargestScores largest;
};

ChannelPlaces channel_places(std::span<const PlacedWindow> all, const ChannelSquares& of,
                             const DiagnosisOptions& options, const std::function<bool()>& cancelled) {
  const RecordedWindows recorded(of.squares);
  const std::vector<double>& squares = recorded.squares();
  const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
  const Excess excess(squares);
  ChannelPlaces places;
  if (excess.variance() <= 0.0 || excess.mean() < 1.0) return places;
  const std::vector<PlacedWindow> windows = recorded.of(all);
  std::vector<std::size_t> drive_of;
  for (const PlacedWindow& window : windows) {
    drive_of.push_back(window.drive);
    if (!window.used) continue;
    for (const double radius_m : options.location.place_radii_m)
      if (auto disc = filled(windows, window, radius_m, of.channel, squares, options.location)) {
        disc->place.share /= sum;
        disc->place.excess = excess(squares, disc->slice);
        places.largest.observed = std::max(places.largest.observed, disc->place.excess);
        places.discs.push_back(std::move(*disc));
      }
  }
  std::vector<double>& by_chance = places.largest.by_chance;
  by_chance.assign(permutation_count(options), 0.0);
  for (std::size_t b = 0; b < by_chance.size() && !cancelled(); ++b) {
    std::vector<double> permuted;
    for (const std::size_t w : reordered(drive_of, random_key(options.seed, kPlaceOrders + b)))
      permuted.push_back(squares[w]);
    for (const FilledDisc& disc : places.discs)
      by_chance[b] = std::max(by_chance[b], excess(permuted, disc.slice));
  }
  return places;
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

double largest_t(const DriveSums& drives, const std::function<double(std::size_t drive)>& sign) {
  double most = 0.0;
  for (int k = 0; k < kBiasFunctions; ++k) {
    double sum = 0.0, square = 0.0;
    for (const auto& [drive, sums] : drives) {
      sum += sign(drive) * sums[k];
      square += sums[k] * sums[k];
    }
    if (square > 0.0) most = std::max(most, std::abs(sum) / std::sqrt(square));
  }
  return most;
}

std::vector<double> sign_flip_significance(std::span<const DriveSums> groups, int resamples,
                                           std::uint64_t seed, const std::function<bool()>& cancelled) {
  std::vector<double> flipped(static_cast<std::size_t>(resamples), 0.0);
  for (std::size_t b = 0; b < flipped.size(); ++b) {
    if (cancelled()) return {};
    const std::uint64_t key = random_key(seed, kSignFlips + b);
    const auto sign = [key](std::size_t drive) { return random_uniform(key, drive) < 0.5 ? -1.0 : 1.0; };
    for (const DriveSums& drives : groups) flipped[b] = std::max(flipped[b], largest_t(drives, sign));
  }
  std::vector<double> significance;
  for (const DriveSums& drives : groups)
    significance.push_back(p_of_permutations(largest_t(drives, [](std::size_t) { return 1.0; }), flipped));
  return significance;
}

std::vector<ChannelGap> channel_gaps(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                     const Eigen::VectorXd& residuals, const DiagnosisOptions& options) {
  const SummedChannels summed = sum_channels(prepared, campaign, residuals, options.location);
  const std::vector<double> significance = sign_flip_significance(
      summed.drives, options.resamples, options.seed, [&] { return prepared.model->cancelled(); });
  std::vector<ChannelGap> gaps;
  for (std::size_t i = 0; i < significance.size(); ++i) {
    const ChannelSums& sums = summed.sums[i];
    ChannelGap gap;
    gap.channel = sums.channel;
    if (sums.wheel >= 0) gap.wheel = campaign.rover->wheels[static_cast<std::size_t>(sums.wheel)].name;
    gap.gap = std::sqrt(sums.square / sums.count);
    gap.noise = std::sqrt(sums.noise / sums.count);
    gap.bias = sums.sum / sums.count;
    gap.significance = significance[i];
    gaps.push_back(gap);
  }
  return gaps;
}

std::vector<Regime> regimes_of(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                               const Eigen::VectorXd& residuals, LookedAt looked_at,
                               const DiagnosisOptions& options) {
  const std::vector<Slice> slices = slices_of(window_variables(prepared, campaign), options.slices);
  return regimes_in(slices, channel_squares(prepared, residuals), drives_of(prepared), looked_at, options,
                    [&] { return prepared.model->cancelled(); });
}

std::vector<ChannelShare> channel_shares(const PreparedCampaign& prepared, const Eigen::VectorXd& residuals,
                                         const DiagnosisOptions& options) {
  return shares_of(channel_squares(prepared, residuals), options);
}

std::vector<FoundPlace> places_in(std::span<const PlacedWindow> windows,
                                  std::span<const ChannelSquares> channels, const DiagnosisOptions& options,
                                  const std::function<bool()>& cancelled) {
  std::vector<std::vector<FilledDisc>> discs;
  std::vector<LargestScores> largest;
  for (const ChannelSquares& of : channels) {
    ChannelPlaces places = channel_places(windows, of, options, cancelled);
    if (cancelled()) return {};
    if (places.discs.empty()) continue;
    discs.push_back(std::move(places.discs));
    largest.push_back(std::move(places.largest));
  }
  const JointSignificance p(std::move(largest));
  std::vector<FoundPlace> found;
  for (std::size_t c = 0; c < discs.size(); ++c)
    for (const FilledDisc& disc : discs[c])
      if (p(c, disc.place.excess) < options.location.max_place_significance) found.push_back(disc.place);
  return found;
}

std::vector<GapPlace> gap_places(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                 const Eigen::VectorXd& residuals, const DiagnosisOptions& options) {
  std::vector<PlacedWindow> windows;
  for (std::size_t w = 0; w < prepared.windows.size(); ++w) {
    const DriveWindow& window = prepared.windows[w];
    const Pose2& middle = window.middle();
    windows.push_back({campaign.drives[window.drive].terrain, window.drive, middle.x_m, middle.y_m,
                       prepared.model->used(w)});
  }
  const auto cancelled = [&] { return prepared.model->cancelled(); };
  std::vector<ChannelSquares> channels;
  for (std::size_t c = 0; c < channel_count(); ++c) {
    const auto channel = static_cast<Channel>(c);
    if (row_of(channel).located) channels.push_back({channel, squares_of(prepared, residuals, channel)});
  }
  std::vector<FoundPlace> found = places_in(windows, channels, options, cancelled);
  std::stable_sort(found.begin(), found.end(),
                   [](const FoundPlace& a, const FoundPlace& b) { return a.excess > b.excess; });
  std::vector<GapPlace> places;
  for (const FoundPlace& place : found) {
    if (places.size() >= static_cast<std::size_t>(options.location.max_places)) break;
    const std::string& terrain = campaign.terrains[place.terrain].name;
    if (std::any_of(places.begin(), places.end(), [&](const GapPlace& p) {
          return p.terrain == terrain &&
                 std::hypot(p.x_m - place.x_m, p.y_m - place.y_m) < p.radius_m + place.radius_m;
        }))
      continue;
    places.push_back({terrain, place.x_m, place.y_m, place.radius_m, place.channel, place.share});
  }
  return places;
}

}  // namespace slipway::gap
