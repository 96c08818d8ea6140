#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gap/estimate/plate_sinkage.h"
#include "sim/single_wheel/single_wheel_rig.h"
#include "sim/single_wheel/sweep_parameter.h"
#include "sim/soil/soil.h"

namespace slipway::gap {

// What a test of the soil measures.
enum class SoilChannel { kTorque, kDrawbarPull, kThrust, kSinkage, kCurrent, kLateralForce, kPressure };
constexpr int kSoilChannels = 7, kWheelChannels = 6;  // all but the plate's pressure are a wheel's

std::string_view name_of(SoilChannel channel);  // "torque", "drawbar_pull", ...
std::string_view unit_of(SoilChannel channel);  // "N m", ...; the boundary's are SI's
std::optional<SoilChannel> soil_channel(std::string_view name);

// A value that was measured, and its standard deviation where that is known.
struct SoilReading {
  std::optional<double> value;
  std::optional<double> std;
};

// One steady test of a wheel: how it was held (wheel, soil and motor are its rig's), and what was measured.
struct WheelObservation {
  sim::WheelRigConditions test;
  std::array<SoilReading, kWheelChannels> readings;
  std::string wheel = {}, soil = {};  // as the test names them; empty where there is one
  std::size_t rig = 0;                // of SoilData::rigs, which are made of these

  SoilReading& operator[](SoilChannel channel) { return readings[static_cast<std::size_t>(channel)]; }
  const SoilReading& operator[](SoilChannel channel) const {
    return readings[static_cast<std::size_t>(channel)];
  }
};

// A wheel on a rig over one of the soils: what is free of it is set by sim::set_sweep_parameter. The soil and
// the test in it are not read.
struct TestRig {
  sim::WheelRig rig;
  std::string wheel = {};  // as tests name it; empty where there is one
  std::size_t soil = 0;    // of SoilData::soils
};
// A rig of a bare wheel.
TestRig rig_of_wheel(const sim::WheelGeometry& wheel, const std::optional<sim::DriveMotor>& drive = {});

struct SoilData {
  std::vector<WheelObservation> wheels = {};
  std::vector<PlateRecord> plates = {};  // in the first soil
  std::vector<TestRig> rigs = {};
  std::vector<std::string> soils = {};  // as tests name them; empty: there is one, without a name

  std::string soil_label(std::size_t soil) const { return soils.empty() ? std::string() : soils[soil]; }
};

// What stands on a rig at some soil, with its effects.
struct RigAt {
  sim::WheelGeometry wheel;
  sim::Soil soil;
  std::optional<sim::DriveMotor> drive;  // a measured current needs it
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
// and the plate's p = (k_c / b + k_phi) z^n. All tests of one rig are evaluated at once, each wheel from
// where it stood before, which makes one soil after another cheap. A wheel that no depth up to the law's end
// carries is held there, so that a search finds its way back; sunk() counts these.
class SoilObservations {
 public:
  // Readings of channels that are not `used` are left out. The data must outlive it.
  SoilObservations(const SoilData& data, const ReadingNoise& noise,
                   const std::array<bool, kSoilChannels>& used);

  std::span<const SoilDatum> data() const { return list_; }
  // One number for each datum, of these rigs (one for each of the data's) and of plates in this soil; false
  // where a soil has no stiffness under some width.
  bool predict(std::span<const RigAt> rigs, const sim::Soil& of_plates, std::span<double> values);
  // All rigs as they are, in one soil.
  bool predict(const sim::Soil& soil, std::span<double> values);
  // Wheels held at the axle when last asked.
  std::size_t sunk() const;
  std::size_t evaluations() const { return evaluations_; }
  // The narrowest wheel, or the smallest plate where there is none: Bekker's b.
  double width_m() const { return width_m_; }
  bool one_width() const { return one_width_; }

 private:
  // The tests of one rig.
  struct Group {
    sim::WheelGeometry wheel;
    std::optional<sim::DriveMotor> drive;
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
  void add_test(std::size_t test);
  void put_on(const RigAt& rig, Group& group);
  double value_of(const SoilDatum& datum) const;
  void list_readings(const ReadingNoise& noise, const std::array<bool, kSoilChannels>& used);
  void balance(Group& group);
  void find_thrust(Group& group);

  const SoilData& data_;
  std::vector<Group> groups_;
  std::vector<std::size_t> place_;  // of each wheel test in its group
  std::vector<SoilDatum> list_;
  double width_m_ = 0.0;
  bool one_width_ = true;
  std::size_t evaluations_ = 0;
};

}  // namespace slipway::gap
