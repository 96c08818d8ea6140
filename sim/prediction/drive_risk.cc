#include "sim/prediction/drive_risk.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/normal_interval.h"
#include "core/parallel_for.h"
#include "core/quantile.h"
#include "core/random.h"

namespace slipway::sim {
namespace {

// The results of one soil draw at the sampled stations of a drive.
struct DrawnDrive {
  std::vector<double> slip, current_a, sinkage_m;  // per sampled station that was reached
  std::vector<bool> bad;                           // true where a limit is broken or the rover is immobilised
  bool immobilised = false;
  double duration_s = 0.0, energy_j = 0.0;
};

// The soils of one draw along the drive: a first-order autoregressive process for each soil distribution.
class DrawnSoils {
 public:
  DrawnSoils(const SoilBeliefs& beliefs, std::uint64_t key) : beliefs_(beliefs), key_(key) {
    for (std::size_t belief = 0; belief <= beliefs.known.size(); ++belief) {
      normals_.push_back(innovation(belief));
      soils_.push_back(draw_soil(of(belief), normals_.back()));
    }
  }

  void advance(double distance_m) {
    if (distance_m <= 0.0) return;
    ++step_;
    for (std::size_t belief = 0; belief < normals_.size(); ++belief) {
      const double kept = std::exp(-distance_m / of(belief).correlation_length_m);
      normals_[belief] = kept * normals_[belief] + std::sqrt(1.0 - kept * kept) * innovation(belief);
      soils_[belief] = draw_soil(of(belief), normals_[belief]);
    }
  }

  const Soil& at(std::optional<std::size_t> soil) const { return soil ? soils_[*soil] : soils_.back(); }

 private:
  const SoilDistribution& of(std::size_t belief) const {
    return belief < beliefs_.known.size() ? beliefs_.known[belief] : beliefs_.unknown;
  }
  SoilNormals innovation(std::size_t belief) const {
    const std::uint64_t key = random_key(key_, belief);
    SoilNormals z;
    for (int k = 0; k < kSoilDims; ++k) z[k] = random_normal(key, step_ * kSoilDims + k);
    return z;
  }

  const SoilBeliefs& beliefs_;
  std::uint64_t key_;
  std::uint64_t step_ = 0;
  std::vector<SoilNormals> normals_;
  std::vector<Soil> soils_;
};

// Every station where the rover turns in place, driven ones about `spacing_m` apart, and always the first and
// last.
std::vector<std::size_t> sampled_stations(std::span<const PreparedStation> stations, double spacing_m) {
  std::vector<std::size_t> sampled{0};
  for (std::size_t k = 1; k < stations.size(); ++k) {
    const bool far = stations[k].distance_m - stations[sampled.back()].distance_m >= spacing_m - 1e-9;
    const bool turn = stations[k].command.turn_in_place && !stations[sampled.back()].command.turn_in_place;
    if (far || turn || k + 1 == stations.size()) sampled.push_back(k);
  }
  return sampled;
}

// The part of the drive that a sampled station represents, which is all since the last sampled one.
PreparedStation span_of(std::span<const PreparedStation> stations, std::size_t after, std::size_t at) {
  PreparedStation span = stations[at];
  for (std::size_t k = after + 1; k < at; ++k) {
    span.drive_m += stations[k].drive_m;
    span.turn_rad += stations[k].turn_rad;
  }
  return span;
}

DrawnDrive drive_on(const RoverModel& rover, double gravity_m_s2, DrawnSoils soils,
                    std::span<const PreparedStation> spans, const DriveLimits& limits,
                    const Progress& progress) {
  DrawnDrive drive;
  QuasiStaticSolver solver(rover, gravity_m_s2);
  for (const PreparedStation& station : spans) {
    if (progress.cancelled()) break;
    soils.advance(station.drive_m);
    PerWheel<Soil> under(station.soil.size());
    for (std::size_t k = 0; k < under.size(); ++k) under[k] = soils.at(station.soil[k]);
    const StationState state = solver.solve(station.stance, under, station.command);
    drive.slip.push_back(state.slip_ratio);
    drive.current_a.push_back(largest_current_a(state));
    drive.sinkage_m.push_back(deepest_sinkage_m(state));
    drive.bad.push_back(!state.moving() || breaks(limits, state) || breaks(limits, station.stance));
    if (!state.moving()) {
      drive.immobilised = true;
      break;
    }
    const Effort effort = effort_of(station, state);
    drive.duration_s += effort.duration_s;
    drive.energy_j += effort.energy_j;
  }
  return drive;
}

// Wilson's interval for a share of n, at 90 % [Wilson 1927].
void set_interval(DrivePrediction& prediction, double share, double n) {
  constexpr double z = kReach90;
  const double centre = (share + z * z / (2.0 * n)) / (1.0 + z * z / n);
  const double half = z / (1.0 + z * z / n) * std::sqrt(share * (1.0 - share) / n + z * z / (4.0 * n * n));
  prediction.risk = share;
  prediction.risk_low = std::max(0.0, centre - half);
  prediction.risk_high = std::min(1.0, centre + half);
}

// Quantiles over the draws that reached a sampled station, for the stations that it stands for.
void fill_station(const std::vector<DrawnDrive>& drives, std::size_t sample, StationPrediction& station) {
  std::vector<double> slip, current, sinkage;
  int bad = 0;
  for (const DrawnDrive& drive : drives) {
    if (sample >= drive.slip.size()) continue;
    slip.push_back(drive.slip[sample]);
    current.push_back(drive.current_a[sample]);
    sinkage.push_back(drive.sinkage_m[sample]);
    bad += drive.bad[sample] ? 1 : 0;
  }
  station.risk = static_cast<double>(bad) / static_cast<double>(drives.size());
  if (slip.empty()) return;  // no draw came this far, so that the values on the mean soils remain
  station.slip_ratio_p05 = quantile(slip, 0.05);
  station.slip_ratio_p50 = quantile(slip, 0.50);
  station.slip_ratio_p95 = quantile(slip, 0.95);
  station.current_a_p95 = quantile(current, 0.95);
  station.sinkage_m_p95 = quantile(sinkage, 0.95);
}

void summarise(const std::vector<DrawnDrive>& drives, DrivePrediction& prediction) {
  std::vector<double> duration, energy;
  double bad = 0.0, immobilised = 0.0;
  for (const DrawnDrive& drive : drives) {
    bad += std::any_of(drive.bad.begin(), drive.bad.end(), [](bool b) { return b; }) ? 1.0 : 0.0;
    immobilised += drive.immobilised ? 1.0 : 0.0;
    if (drive.immobilised) continue;
    duration.push_back(drive.duration_s);
    energy.push_back(drive.energy_j);
  }
  const double n = static_cast<double>(drives.size());
  prediction.draws = static_cast<int>(drives.size());
  set_interval(prediction, bad / n, n);
  prediction.risk_immobilised = immobilised / n;
  prediction.duration_s_p95 = duration.empty() ? prediction.duration_s : quantile(duration, 0.95);
  prediction.energy_j_p95 = energy.empty() ? prediction.energy_j : quantile(energy, 0.95);
}

}  // namespace

double largest_current_a(const StationState& state) {
  double largest = 0.0;
  for (const WheelState& wheel : state.wheels) largest = std::max(largest, std::abs(wheel.current_a));
  return largest;
}

double deepest_sinkage_m(const StationState& state) {
  double deepest = 0.0;
  for (const WheelState& wheel : state.wheels) deepest = std::max(deepest, wheel.sinkage_m);
  return deepest;
}

bool breaks(const DriveLimits& limits, const StationState& state) {
  return std::abs(state.slip_ratio) > limits.max_slip_ratio ||
         largest_current_a(state) > limits.max_current_a || deepest_sinkage_m(state) > limits.max_sinkage_m;
}

bool breaks(const DriveLimits& limits, const Stance& stance) {
  return stance.attitude.tilt_rad() > limits.max_tilt_rad ||
         stance.belly_clearance_m < limits.min_clearance_m;
}

Effort effort_of(const PreparedStation& station, const StationState& state) {
  Effort effort;
  if (station.command.turn_in_place) {
    effort.duration_s = station.turn_rad / std::abs(state.yaw_rate_rad_s);
  } else if (station.drive_m > 0.0) {
    // Distances are horizontal, as those of paths.
    const Eigen::Vector2d d = travel_direction(station.command);
    const double rise = station.stance.R_MB(2, 0) * d.x() + station.stance.R_MB(2, 1) * d.y();
    const double over_ground = std::abs(state.along_m_s) * std::sqrt(1.0 - rise * rise);
    effort.duration_s = station.drive_m / over_ground;
  }
  effort.energy_j = effort.duration_s * state.electric_power_w;
  return effort;
}

bool assess_risk(const RoverModel& rover, double gravity_m_s2, const SoilBeliefs& beliefs,
                 std::span<const PreparedStation> stations, const DriveLimits& limits,
                 const RiskOptions& options, std::size_t threads, Progress& progress,
                 DrivePrediction& prediction) {
  const std::vector<std::size_t> sampled = sampled_stations(stations, options.spacing_m);
  std::vector<PreparedStation> spans;
  for (std::size_t s = 0; s < sampled.size(); ++s)
    spans.push_back(span_of(stations, s == 0 ? sampled[0] : sampled[s - 1], sampled[s]));

  std::vector<DrawnDrive> drives(static_cast<std::size_t>(options.draws));
  parallel_for(drives.size(), threads, [&](std::size_t draw) {
    DrawnSoils soils(beliefs, random_key(options.seed, draw));
    drives[draw] = drive_on(rover, gravity_m_s2, std::move(soils), spans, limits, progress);
  });
  if (progress.cancelled()) return false;

  summarise(drives, prediction);
  std::size_t sample = 0;
  for (std::size_t k = 0; k < prediction.stations.size(); ++k) {
    while (sample + 1 < sampled.size() && sampled[sample] < k) ++sample;
    StationPrediction& station = prediction.stations[k];
    fill_station(drives, sample, station);
    if (station.risk > prediction.worst_place.value)
      prediction.worst_place = {station.risk, station.station.distance_m};
  }
  return true;
}

}  // namespace slipway::sim
