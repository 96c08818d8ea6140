#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/pose.h"
#include "sim/rover/drive_command.h"
#include "sim/rover/ground.h"
#include "sim/rover/rover_model.h"
#include "sim/soil/soil.h"
#include "sim/wheel/per_wheel.h"

namespace slipway::gap {

// A channel without a measurement at that time.
constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

struct WheelReading {
  double rate_rad_s = kNotMeasured;  // positive rolls forward
  double steer_rad = kNotMeasured;   // positive to the left
  double current_a = kNotMeasured;   // at the motor, positive in the sense of the rate where driving
  double sinkage_m = kNotMeasured;   // of the lowest point below the undisturbed surface
  double motor_temp_c = kNotMeasured;
};

// One row of a drive's file. A pose is measured as a whole or not at all; so is an attitude.
struct DriveSample {
  double time_s = 0.0;
  Eigen::Vector3d p_MB = Eigen::Vector3d::Constant(kNotMeasured);
  Attitude attitude{kNotMeasured, kNotMeasured, kNotMeasured};
  sim::PerWheel<WheelReading> wheels;
  double bus_voltage_v = kNotMeasured;
};

// A drive as commanded and as measured.
struct MeasuredDriveSeries {
  std::string id;
  std::size_t terrain = 0;    // index into DriveCampaign::terrains
  sim::DriveCommand command;  // without a motor temperature
  double duration_s = 0.0;    // commanded
  std::optional<std::string> repeat_of;
  bool final_only = false;           // the first and the last row alone: says something of the pose
  std::vector<DriveSample> samples;  // time increasing, two at least
};

struct CampaignTerrain {
  std::string name;
  // Its soils are indices into DriveCampaign::soils.
  std::shared_ptr<const sim::Ground> ground;
  std::string fingerprint;  // of heights and classes, for provenance
};

struct NominalSoil {
  std::string name;
  sim::Soil soil;
};

// One standard deviation of each measured channel.
struct MeasurementStd {
  double position_m = 0.0;
  double attitude_rad = 0.0;
  double current_relative = 0.0;  // of the current, in quadrature with current_a
  double current_a = 0.0;
  double sinkage_m = 0.0;
};

struct ReferenceBelief;

// How much of soil, closures and motors a diagnosis may re-tune. Less than all is for ablations: what it
// holds at nominal is believed to be exact.
enum class Retuning { kAll, kNoClosures, kNone };

// Recorded drives and what was known before them ("drive-campaign/1"): rover, nominal soils, terrain. It
// never says what made prediction and drives differ.
struct DriveCampaign {
  std::string name;
  double gravity_m_s2 = 0.0;
  std::shared_ptr<const sim::RoverModel> rover;
  std::vector<NominalSoil> soils;
  std::vector<CampaignTerrain> terrains;
  MeasurementStd measurement_std;
  // How well nominal parameters are known, by the names of nuisance_catalogue(): one standard deviation of
  // each that was measured apart from these drives. Those that are not in it are known as well as they
  // usually are.
  std::map<std::string, double, std::less<>> parameter_std;
  std::vector<MeasuredDriveSeries> drives;
  std::vector<std::string> notes;  // columns that were not read, repairs: for people
  std::string fingerprint;         // of every byte that was read
  Retuning retuning = Retuning::kAll;
  // What drives of the same rover that are taken as healthy have told before: the question is then what has
  // changed since. None: nothing was known but the nominal model.
  std::shared_ptr<const ReferenceBelief> reference;
};

// Wheels that were measured to turn faster than the rover's greatest rate raise it, with a note: the drives
// were made so, and a rover that is held to less would not repeat them.
void adopt_measured_rates(DriveCampaign& campaign);

// A note of drives whose wheels turned against what was commanded. They are read all the same.
void note_turned_against_command(DriveCampaign& campaign);

// Whether two drives were recorded as the same rows, whatever they are called. Where no pose was measured
// nobody can say.
bool same_rows(const MeasuredDriveSeries& a, const MeasuredDriveSeries& b);

// Drives with the very rows of an earlier one of the same terrain become repeats of it, with a note: they are
// one recording under two names, or the same drive of a simulator without noise, and say nothing new of
// drives that were not made.
void take_same_rows_as_repeats(DriveCampaign& campaign);

// The campaign as if these drives alone had been made, in this order. Repeats of a drive that is left out are
// repeats of the first of them. `drives`: indices into DriveCampaign::drives, each once.
DriveCampaign subset_of(const DriveCampaign& campaign, std::span<const std::size_t> drives);
// The same of those from an index to before another.
DriveCampaign drives_between(const DriveCampaign& campaign, std::size_t from, std::size_t to);

}  // namespace slipway::gap
