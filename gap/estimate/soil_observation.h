#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "gap/estimate/plate_sinkage.h"
#include "sim/single_wheel/single_wheel_rig.h"
#include "sim/soil/soil.h"

namespace slipway::gap {

// What a test of the soil measures.
enum class SoilChannel { kTorque, kDrawbarPull, kThrust, kSinkage, kCurrent, kPressure };
constexpr int kSoilChannels = 6, kWheelChannels = 5;  // all but the plate's pressure are a wheel's

std::string_view name_of(SoilChannel channel);  // "torque", "drawbar_pull", ...
std::string_view unit_of(SoilChannel channel);  // "N m", ...; the boundary's are SI's
std::optional<SoilChannel> soil_channel(std::string_view name);

// A value that was measured, and its standard deviation where that is known.
struct SoilReading {
  std::optional<double> value;
  std::optional<double> std;
};

// One steady test of a wheel: how it was held (the soil in it is not read), and what was measured. A current
// needs the test's motor.
struct WheelObservation {
  sim::WheelRigConditions test;
  std::array<SoilReading, kWheelChannels> readings;

  SoilReading& operator[](SoilChannel channel) { return readings[static_cast<std::size_t>(channel)]; }
  const SoilReading& operator[](SoilChannel channel) const {
    return readings[static_cast<std::size_t>(channel)];
  }
};

struct SoilData {
  std::vector<WheelObservation> wheels;
  std::vector<PlateRecord> plates;
};

// The standard deviation of a reading that has none of its own: a share of it in quadrature with a share of
// the channel's root mean square.
struct ReadingNoise {
  double share = 0.02;
  double share_of_rms = 0.005;
};

// One measured number among all of a SoilData.
struct SoilDatum {
  SoilChannel channel = SoilChannel::kTorque;
  std::size_t test = 0;    // index into SoilData::wheels or plates
  std::size_t sample = 0;  // of a plate
  double measured = 0.0;
  double std = 1.0;
};

// What tests measure on a soil, by the library's own laws: sim::wheel_forces where the soil carries the load,
// and the plate's p = (k_c / b + k_phi) z^n. All wheels of one geometry are evaluated at once, each from
// where it stood before, which makes one soil after another cheap. A wheel that no depth up to the axle
// carries is held at the axle, so that a search finds its way back; sunk() counts these.
class SoilObservations {
 public:
  // Readings of channels that are not `used` are left out. The data must outlive it.
  SoilObservations(const SoilData& data, const ReadingNoise& noise,
                   const std::array<bool, kSoilChannels>& used);

  std::span<const SoilDatum> data() const { return list_; }
  // One number for each datum; false where the soil has no stiffness under some width.
  bool predict(const sim::Soil& soil, std::span<double> values);
  // Wheels held at the axle when last asked.
  std::size_t sunk() const;
  std::size_t evaluations() const { return evaluations_; }
  // The narrowest wheel, or the smallest plate where there is none: Bekker's b.
  double width_m() const { return width_m_; }
  bool one_width() const { return one_width_; }

 private:
  // Wheels of one geometry.
  struct Group {
    sim::WheelGeometry wheel;
    std::vector<std::size_t> tests;
    std::vector<sim::WheelMotion> motions;
    std::vector<double> loads_n, rim_speeds_m_s, angles, slopes;
    std::vector<bool> held, sunk;
    bool any_thrust = false;
    std::vector<sim::Soil> soils;
    std::vector<sim::WheelForces> forces, before;
    std::vector<double> tried, thrusts;
    bool warm = false;
  };
  void add_wheel(std::size_t test);
  void list_readings(const ReadingNoise& noise, const std::array<bool, kSoilChannels>& used);
  void balance(Group& group);
  void find_thrust(Group& group);

  const SoilData& data_;
  std::vector<Group> groups_;
  std::vector<std::pair<std::size_t, std::size_t>> place_;  // of each wheel: group, index there
  std::vector<SoilDatum> list_;
  double width_m_ = 0.0;
  bool one_width_ = true;
  std::size_t evaluations_ = 0;
};

}  // namespace slipway::gap
