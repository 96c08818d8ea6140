#pragma once

#include <array>
#include <string_view>

namespace slipway::steps {

// The columns of "slip-steps/1" in the order in which they are written, then those that are read alone.
enum StepColumn : std::size_t {
  kSol,
  kEt,
  kSite,
  kSiteNorth,
  kSiteEast,
  kSiteDown,
  kXEqc,
  kYEqc,
  kOdometry,
  kSlip,
  kSide,
  kPitchStart,
  kPitchEnd,
  kRollStart,
  kRollEnd,
  kHeading,
  kBackward,
  kDriveTime,
  kPathPitch,
  kCourse,
  kAttitude,
  kDemClimb,
  kTerrainUnit,
  kSolPitch,
  kClock,
  kEast,
  kNorth,
  kStepLength,
  kStepTime,
  kNominal,
  kNominalSlip,
  kSolLength,
  kStepColumns
};

struct StepColumnRow {
  std::string_view name;
  double lowest, highest;  // of what is no word
  bool whole = false;
  bool words = false;
};

inline constexpr std::array<StepColumnRow, kStepColumns> kStepColumnRows{{
    {"sol", 0.0, 1e5, true},
    {"et_s", -1e12, 1e12},
    {"site", 0.0, 1e5, true},
    {"site_north_m", -1e7, 1e7},
    {"site_east_m", -1e7, 1e7},
    {"site_down_m", -1e7, 1e7},
    {"x_eqc_m", -1e8, 1e8},
    {"y_eqc_m", -1e8, 1e8},
    {"odometry_m", 0.0, 1000.0},
    {"slip", -1.0, 1.5},
    {"side_m", -1000.0, 1000.0},
    {"climb_pitch_start_deg", -90.0, 90.0},
    {"climb_pitch_end_deg", -90.0, 90.0},
    {"roll_start_deg", -180.0, 180.0},
    {"roll_end_deg", -180.0, 180.0},
    {"heading_deg", -360.0, 360.0},
    {"backward", 0.0, 1.0, true},
    {"drive_s", 0.0, 1e6},
    {"path_pitch_deg", -90.0, 90.0},
    {"course_deg", -360.0, 360.0},
    {"attitude", 0.0, 0.0, false, true},
    {"dem_climb_deg", -90.0, 90.0},
    {"terrain_unit", 0.0, 0.0, false, true},
    {"sol_mean_climb_deg", -90.0, 90.0},
    {"sclk_s", 0.0, 1e12},
    {"east_m", -1e7, 1e7},
    {"north_m", -1e7, 1e7},
    {"step_m", 0.0, 1000.0},
    {"dt_s", 0.0, 1e6},
    {"nominal_m", 0.0, 1000.0},
    {"slip_if_nominal", -1.0, 1.5},
    {"sol_leg_m", 0.0, 1e6},
}};

}  // namespace slipway::steps
