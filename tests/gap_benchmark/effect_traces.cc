#include "effect_traces.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>

#include "sensor_errors.h"

namespace slipway::gap_benchmark {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double kStretch_m = 1.5, kStretch_rad = 0.8;
constexpr double kStuckSlip = 0.9;  // a reading above it only says that the slip was high

struct Stretch {
  std::size_t from = 0, to = 0;  // rows, both in it
  std::size_t middle() const { return (from + to) / 2; }
};

// Stretches of nearly equal time; neighbours share a row.
std::vector<Stretch> stretches_of(const MadeDrive& drive) {
  const std::vector<DriveRow>& rows = drive.rows;
  const double start_s = rows.front().time_s, duration_s = rows.back().time_s - start_s;
  const double step_s = rows[1].time_s - start_s;
  const double asked_s = drive.order.turn_in_place ? kStretch_rad / std::abs(drive.order.turn_rate_rad_s())
                                                   : kStretch_m / std::abs(drive.order.speed_m_s);
  const long count = std::max(1L, std::lround(duration_s / std::max(asked_s, 2.0 * step_s)));
  std::vector<Stretch> stretches;
  std::size_t from = 0;
  for (long i = 1; i <= count; ++i) {
    const double end_s = start_s + duration_s * static_cast<double>(i) / static_cast<double>(count);
    std::size_t to = from;
    while (to + 1 < rows.size() && rows[to].time_s < end_s - 1e-9) ++to;
    if (to > from) stretches.push_back({from, to});
    from = to;
  }
  return stretches;
}

// One value for each wheel in a channel of the wheels, otherwise a single one.
using Reading = std::array<std::vector<double>, kTraceChannels.size()>;

// The readings of sensors without noise. The motion is computed as from a log, with the recorded heading and
// attitude.
Reading reading_of(const DriveOrder& order, const DriveRow& row) {
  const RoverMotion& m = row.motion;
  const double ahead = m.forward_m_s * std::cos(m.pitch_rad) +
                       m.left_m_s * std::sin(m.pitch_rad) * std::sin(m.roll_rad),
               aside = m.left_m_s * std::cos(m.roll_rad);
  const double off = m.heading_rad - row.yaw_rad;
  const double level_ahead = std::cos(off) * ahead - std::sin(off) * aside,
               level_aside = std::sin(off) * ahead + std::cos(off) * aside;
  const double left = level_aside / std::cos(row.roll_rad);
  const double forward =
      (level_ahead - left * std::sin(row.pitch_rad) * std::sin(row.roll_rad)) / std::cos(row.pitch_rad);
  const double turned = m.recorded_turn_rad_s * std::cos(row.pitch_rad) / std::cos(row.roll_rad);
  Reading reading;
  if (order.turn_in_place) {
    reading[kSlip] = {1.0 - turned / order.turn_rate_rad_s()};
  } else {
    reading[kSlip] = {1.0 - forward / order.speed_m_s};
    reading[kSideSlip] = {left / std::abs(order.speed_m_s)};
    reading[kYawRate] = {turned - order.turn_rate_rad_s()};
  }
  reading[kRoll] = {row.roll_rad};
  reading[kPitch] = {row.pitch_rad};
  for (const WheelRow& wheel : row.wheels) {
    reading[kCurrent].push_back(wheel.current_a);
    reading[kSinkage].push_back(wheel.sinkage_m);
  }
  return reading;
}

// The standard deviation of the mean of a stretch's readings due to its sensors alone; for speeds and rates
// that of the line through positions or headings.
double sensor_deviation(std::size_t channel, const DriveOrder& order, std::span<const DriveRow> rows,
                        std::size_t surveyed, double mean) {
  double middle_s = 0.0, spread = 0.0;
  const auto n = static_cast<double>(rows.size());
  for (const DriveRow& row : rows) middle_s += row.time_s / n;
  for (const DriveRow& row : rows) spread += std::pow(row.time_s - middle_s, 2);
  const double attitude = kAttitudeStd_deg / kDegPerRad;
  const double speed = kPositionStd_m / std::sqrt(spread) / std::abs(order.speed_m_s);
  switch (channel) {
    case kSlip:
      return order.turn_in_place ? attitude / std::sqrt(spread) / std::abs(order.turn_rate_rad_s()) : speed;
    case kSideSlip:
      return std::hypot(speed, attitude / std::sqrt(n));
    case kYawRate:
      return attitude / std::sqrt(spread);
    case kCurrent:
      return std::hypot(kCurrentStd_a, kCurrentRel * mean) / std::sqrt(n);
    case kSinkage:
      return kSinkageStd_m / std::sqrt(static_cast<double>(surveyed));
    default:
      return attitude / std::sqrt(n);
  }
}

// The world without the hidden causes, and worlds whose stiffness, friction or shear modulus is off by one
// standard deviation of the scatter from drive to drive.
struct Worlds {
  World bare;
  std::array<World, 3> scattered;
};
Worlds worlds_of(const World& world) {
  // Drawn within two deviations from drive to drive, and along a drive on top.
  constexpr double kBoundedVariance = 0.774;
  const double share = std::sqrt(kBoundedVariance + world.scatter.along * world.scatter.along);
  Worlds worlds{world, {}};
  worlds.bare.hidden = {};
  worlds.bare.hidden.other_equations = world.hidden.other_equations;
  worlds.scattered.fill(worlds.bare);
  worlds.scattered[0].soil.k_c *= std::exp(share * world.scatter.stiffness);
  worlds.scattered[0].soil.k_phi *= std::exp(share * world.scatter.stiffness);
  worlds.scattered[1].soil.friction_rad *= std::exp(share * world.scatter.friction);
  worlds.scattered[2].soil.shear_modulus_m *= std::exp(share * world.scatter.shear_modulus);
  return worlds;
}

class DriveTraces {
 public:
  DriveTraces(const SealedCampaign& campaign, const Worlds& worlds, const MadeDrive& drive)
      : campaign_(campaign), drive_(drive), stretches_(stretches_of(drive)) {
    without_ = replayed(worlds.bare, drive.rows);
    std::vector<DriveRow> middles;
    for (const Stretch& stretch : stretches_) middles.push_back(drive.rows[stretch.middle()]);
    for (std::size_t i = 0; i < scattered_.size(); ++i)
      scattered_[i] = replayed(worlds.scattered[i], middles);
  }

  std::vector<EffectTrace> traces() const {
    std::vector<EffectTrace> all;
    for (std::size_t s = 0; s < stretches_.size(); ++s) {
      EffectTrace trace{drive_.order.id, {}, {}};
      if (fill(s, trace)) all.push_back(std::move(trace));
    }
    return all;
  }

 private:
  std::vector<std::optional<DriveRow>> replayed(const World& world, std::span<const DriveRow> rows) const {
    for (const NamedTerrain& terrain : campaign_.terrains) {
      if (terrain.name != drive_.order.terrain) continue;
      RandomStream random(drive_.soil_seed);
      return replay_drive(world, terrain.grid, drive_.order, random, rows);
    }
    return std::vector<std::optional<DriveRow>>(rows.size());
  }

  bool fill(std::size_t s, EffectTrace& trace) const {
    const Stretch& stretch = stretches_[s];
    std::vector<std::pair<DriveRow, DriveRow>> pairs;  // with and without
    for (std::size_t i = stretch.from; i <= stretch.to; ++i)
      if (without_[i]) pairs.emplace_back(drive_.rows[i], *without_[i]);
    const std::optional<DriveRow>& middle = without_[stretch.middle()];
    if (pairs.empty() || !middle) return false;
    for (const auto& scattered : scattered_)
      if (!scattered[s]) return false;
    fill_variables(stretch, pairs, trace);
    const std::span<const DriveRow> rows =
        std::span(drive_.rows).subspan(stretch.from, stretch.to - stretch.from + 1);
    for (std::size_t c = 0; c < kTraceChannels.size(); ++c) {
      if (c == kSinkage && !campaign_.made_of.sinkage) continue;
      if (c == kSlip && trace.variables[2] > kStuckSlip) continue;
      const auto is_read = [c](const DriveRow& row) { return c != kSinkage || row.surveyed; };
      const auto count = static_cast<std::size_t>(
          std::count_if(pairs.begin(), pairs.end(), [&](const auto& pair) { return is_read(pair.first); }));
      const Reading here = reading_of(drive_.order, *middle);
      if (count == 0 || here[c].empty()) continue;
      double squares = 0.0;
      for (std::size_t k = 0; k < here[c].size(); ++k) {
        double change = 0.0, mean = 0.0;
        for (const auto& [with, without] : pairs) {
          if (!is_read(with)) continue;
          const double value = reading_of(drive_.order, with)[c][k];
          change += (value - reading_of(drive_.order, without)[c][k]) / static_cast<double>(count);
          mean += value / static_cast<double>(count);
        }
        double variance = std::pow(sensor_deviation(c, drive_.order, rows, count, mean), 2);
        for (const auto& scattered : scattered_)
          variance += std::pow(reading_of(drive_.order, *scattered[s])[c][k] - here[c][k], 2);
        squares += change * change / variance;
      }
      trace.mean_square[c] = squares / static_cast<double>(here[c].size());
    }
    return true;
  }

  void fill_variables(const Stretch& stretch, std::span<const std::pair<DriveRow, DriveRow>> pairs,
                      EffectTrace& trace) const {
    const DriveOrder& order = drive_.order;
    const double sense = order.speed_m_s < 0.0 && !order.turn_in_place ? -1.0 : 1.0;
    const auto n = static_cast<double>(pairs.size());
    auto& v = trace.variables;
    for (const auto& [with, without] : pairs) {
      v[0] -= sense * with.motion.pitch_rad * kDegPerRad / n;
      v[1] += with.motion.roll_rad * kDegPerRad / n;
      v[2] += reading_of(order, with)[kSlip][0] / n;
      v[5] += with.motor_temp_c / n;
    }
    v[3] = order.turn_in_place ? 0.0 : order.speed_m_s;
    v[4] = order.turn_in_place ? 0.0 : order.curvature_1_m;
    v[6] = order.turn_in_place ? 1.0 : 0.0;
    v[7] = 0.5 * (drive_.rows[stretch.from].time_s + drive_.rows[stretch.to].time_s) -
           drive_.rows.front().time_s;
  }

  const SealedCampaign& campaign_;
  const MadeDrive& drive_;
  std::vector<Stretch> stretches_;
  std::vector<std::optional<DriveRow>> without_;                   // of every row
  std::array<std::vector<std::optional<DriveRow>>, 3> scattered_;  // of the row in each stretch's middle
};

}  // namespace

std::vector<EffectTrace> effect_traces(const SealedCampaign& campaign) {
  std::vector<EffectTrace> all;
  if (campaign.effects.empty()) return all;
  const Worlds worlds = worlds_of(campaign.world);
  for (const MadeDrive& drive : campaign.drives)
    for (EffectTrace& trace : DriveTraces(campaign, worlds, drive).traces()) all.push_back(std::move(trace));
  return all;
}

std::string traces_header() {
  std::string out = "campaign,drive";
  for (const char* variable : kTraceVariables) out += std::string(",") + variable;
  for (const char* channel : kTraceChannels) out += std::string(",") + channel + "_mean_square";
  return out + "\n";
}

std::string traces_rows(const std::string& campaign, const std::vector<EffectTrace>& traces) {
  std::string out;
  const auto number = [&](double value) {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.6g", value);
    out += text.data();
  };
  for (const EffectTrace& trace : traces) {
    out += campaign + "," + trace.drive;
    for (const double value : trace.variables) {
      out += ',';
      number(value);
    }
    for (const std::optional<double>& square : trace.mean_square) {
      out += ',';
      if (square) number(*square);
    }
    out += '\n';
  }
  return out;
}

}  // namespace slipway::gap_benchmark
