#include "effect_traces.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>

#include "random_stream.h"

namespace slipway::gap_benchmark {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

// The world without the hidden causes, and worlds whose stiffness, friction or shear modulus is off by one
// standard deviation of the scatter from drive to drive.
struct Worlds {
  World bare;
  std::array<World, 3> scattered;
};
Worlds worlds_of(const World& world) {
  // Along a drive it scatters on top.
  const double share = std::sqrt(RandomStream::kBoundedVariance + world.scatter.along * world.scatter.along);
  Worlds worlds{without_hidden_causes(world), {}};
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
    without_ = replayed(campaign, worlds.bare, drive, drive.rows);
    std::vector<DriveRow> middles;
    for (const Stretch& stretch : stretches_) middles.push_back(drive.rows[stretch.middle()]);
    for (std::size_t i = 0; i < scattered_.size(); ++i)
      scattered_[i] = replayed(campaign, worlds.scattered[i], drive, middles);
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
  bool fill(std::size_t s, EffectTrace& trace) const {
    const Stretch& stretch = stretches_[s];
    const MeanReading means = mean_reading_of(drive_, stretch, without_);
    const std::optional<DriveRow>& middle = without_[stretch.middle()];
    if (means.rows[kSlip] == 0 || !middle) return false;
    const Reading here = reading_of(drive_.order, *middle);
    std::vector<Reading> there;
    for (const auto& scattered : scattered_) {
      if (!scattered[s]) return false;
      there.push_back(reading_of(drive_.order, *scattered[s]));
    }
    fill_variables(stretch, means, trace);
    const std::span<const DriveRow> rows =
        std::span(drive_.rows).subspan(stretch.from, stretch.to - stretch.from + 1);
    for (std::size_t c = 0; c < kTraceChannels.size(); ++c) {
      if (c == kSinkage && !campaign_.made_of.sinkage) continue;
      if (c == kSlip && trace.variables[2] > kStuckSlip) continue;
      if (means.rows[c] == 0 || here[c].empty()) continue;
      double squares = 0.0;
      for (std::size_t k = 0; k < here[c].size(); ++k) {
        double variance =
            std::pow(sensor_deviation(c, drive_.order, rows, means.rows[c], means.mean[c][k]), 2);
        for (const Reading& scattered : there) variance += std::pow(scattered[c][k] - here[c][k], 2);
        squares += means.change[c][k] * means.change[c][k] / variance;
      }
      trace.mean_square[c] = squares / static_cast<double>(here[c].size());
    }
    return true;
  }

  void fill_variables(const Stretch& stretch, const MeanReading& means, EffectTrace& trace) const {
    const DriveOrder& order = drive_.order;
    const double sense = order.speed_m_s < 0.0 && !order.turn_in_place ? -1.0 : 1.0;
    const auto n = static_cast<double>(means.rows[kSlip]);
    auto& v = trace.variables;
    for (std::size_t i = stretch.from; i <= stretch.to; ++i) {
      if (!without_[i]) continue;
      const DriveRow& with = drive_.rows[i];
      v[0] -= sense * with.motion.pitch_rad * kDegPerRad / n;
      v[1] += with.motion.roll_rad * kDegPerRad / n;
      v[5] += with.motor_temp_c / n;
    }
    v[2] = means.mean[kSlip][0];
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
