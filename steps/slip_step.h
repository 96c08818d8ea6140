#pragma once

#include <optional>
#include <string>

namespace slipway::steps {

// Where a step's attitude comes from.
enum class StepAttitude { kNone, kCk };

// One step of a rover whose slip was measured: the wheels' odometry said how far it went, and a fix of the
// position (visual odometry on Mars) said how far it came. What is empty is not known. Angles of the body are
// in the sense of travel: a rover that backs up a slope climbs. Map angles are clockwise from north.
struct SlipStep {
  int sol = 0;
  double et_s = 0.0;  // end of the drive, TDB seconds past J2000; 0 where it is not known
  std::optional<int> site;
  std::optional<double> site_north_m, site_east_m, site_down_m;  // start of the step, in the site's frame
  std::optional<double> x_eqc_m, y_eqc_m;  // the same place on an equidistant cylindrical map
  double odometry_m = 0.0;                 // length by the wheels, above 0
  double slip = 0.0;                       // 1 - way made good along the step / odometry
  std::optional<double> side_m;            // way made good to the right of travel
  std::optional<double> climb_pitch_start_rad, climb_pitch_end_rad;  // of the body; climbing is positive
  std::optional<double> roll_start_rad, roll_end_rad;  // of the body; right side down is positive
  std::optional<double> heading_rad;                   // of the body's x axis
  std::optional<bool> backward;                        // the body's x axis points back
  std::optional<double> drive_s;                       // the time in motion
  std::optional<double> path_pitch_rad;                // slope of the step itself
  std::optional<double> course_rad;                    // direction of travel
  StepAttitude attitude = StepAttitude::kNone;
  std::optional<double> dem_climb_rad;  // climb of a terrain map along the step
  std::string terrain_unit;             // of a terrain map; empty: none
  bool pitch_is_of_sol = false;         // path_pitch_rad is the mean of the sol, not of this step

  // The mean roll of start and end, or the one that is known, or 0.
  double roll_rad() const {
    if (roll_start_rad && roll_end_rad) return 0.5 * (*roll_start_rad + *roll_end_rad);
    return roll_start_rad.value_or(roll_end_rad.value_or(0.0));
  }

  // The slope along the step: of the step itself, or of the map, or else the mean pitch of the body. Only a
  // table of sols' mean pitches may leave all of them open.
  std::optional<double> climb_rad() const {
    if (path_pitch_rad) return path_pitch_rad;
    if (dem_climb_rad) return dem_climb_rad;
    if (climb_pitch_start_rad && climb_pitch_end_rad)
      return 0.5 * (*climb_pitch_start_rad + *climb_pitch_end_rad);
    return climb_pitch_start_rad ? climb_pitch_start_rad : climb_pitch_end_rad;
  }

  bool operator==(const SlipStep&) const = default;
};

}  // namespace slipway::steps
