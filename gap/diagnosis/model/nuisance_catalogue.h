#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "sim/rover/rover_model.h"
#include "sim/soil/soil.h"

namespace slipway::gap {

// Something that a diagnosis may re-tune without calling it a missing effect: a soil's parameter that is
// known only so well, a closure of the laws that nobody measures, a constant of the motors.
enum class NuisanceKind { kSoil, kClosure, kMotor, kSensor };

struct Nuisance {
  std::string_view name;
  std::string_view summary;
  NuisanceKind kind = NuisanceKind::kSoil;
  // The model is unchanged at 0, and 0 is believed with this deviation, unless DriveCampaign::parameter_std
  // says otherwise.
  double std = 0.1;
  double lowest = -1.0, highest = 1.0;
  // Of kSoil, once for each soil; of the others, once in all.
  void (*on_soil)(double value, sim::Soil& soil) = nullptr;
  void (*on_rover)(double value, sim::RoverModel& rover) = nullptr;
};

// The quantities of a soil that scatter from drive to drive or are estimated, in the order of
// sim::SoilNormals, and their rows' names.
enum class SoilQuantity { kStiffness, kN, kCohesion, kFriction, kShearModulus };
inline constexpr std::array<std::string_view, sim::kSoilDims> kSoilNuisances{"stiffness", "n", "cohesion",
                                                                             "friction", "shear_modulus"};
std::optional<SoilQuantity> quantity_of(const Nuisance& row);

// A row of kClosure that acts on soils: how unlike they shear across and along.
inline constexpr std::string_view kLateralShearModulus = "lateral_shear_modulus";

// A row of kSensor that neither soil nor rover feels: seconds by which headings are recorded later than
// positions, which turns the way that a turning rover seems to go.
inline constexpr std::string_view kPoseLag = "pose_lag_s";

// A row of kSensor: the share of a track's depth that recorded sinkages leave out, where they are read from
// the track's bottom and not from the ground around. Matters where wheels follow each other in tracks.
inline constexpr std::string_view kTrackLeftOut = "track_left_out";

// A row of kMotor, free where a campaign recorded the total of the currents alone: then motors were not
// calibrated one by one, and what the electronics draw is in it. There the torque constant is believed by
// kTotalTorqueStd only.
inline constexpr std::string_view kIdleCurrent = "idle_current";
inline constexpr double kTotalTorqueStd = 0.3;

// A new one is a row.
std::span<const Nuisance> nuisance_catalogue();

}  // namespace slipway::gap
