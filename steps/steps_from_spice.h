#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/angle.h"
#include "core/result.h"
#include "sky/mars_time.h"
#include "steps/kernel_bytes.h"
#include "steps/slip_step.h"

// Steps of measured slip out of a rover's reconstructed SPICE kernels. A kernel of positions has what wheel
// odometry gave, and the jump by which visual odometry corrected it while the rover stood:
// docs/reference/slip_steps.md has the rules.
namespace slipway::steps {

// Whose steps, and what is taken for one. As it stands here: Curiosity (NAIF's ids of MSL).
struct SpiceStepOptions {
  int rover = -76;            // target of the positions
  int site_zero = -76500;     // site NN is the body with this id less NN, in the rover's positions the centre
  int most_sites = 399;       // ids beyond are no sites
  int landing_site = -76900;  // centre of the sites
  int level_frame = -76910;   // north, east, down; frame of the positions and reference of the attitudes
  int instrument = -76000;    // of the attitudes: the rover's body, x forward, y right, z down
  int clock = 76;             // id of the clock, without its sign
  int planet = 499;           // centre of the landing site
  int planet_frame = 10014;   // body-fixed frame in which it is given
  double map_radius_m = 3396190.0;     // of the equidistant cylindrical map
  double sol_zero_et_s = 397446670.0;  // mean local midnight before the landing, which was on sol 0
  double sol_length_s = sky::kSol_s;
  double rest_m = 0.003;                 // less than this is rest
  double turn_rad = rad_from_deg(0.04);  // a drive turns the body by more than this, a correction does not
  double longest_gap_s = 600.0;
  double shortest_m = 0.45, longest_m = 2.2;
  double widest_off_axis_rad = rad_from_deg(14.0);  // of the travel from the body's axis
  double clock_slack_s = 0.02;                      // an attitude within this of a state is its attitude
  // Without attitudes a jump is a correction unless it goes forward by more than this share of the step, or
  // is itself a step that the rover is commanded by default, or is longer than the step.
  double most_forward = 0.2;
  std::vector<double> default_steps_m{0.5, 0.765, 1.0};
  double default_step_slack_m = 0.03;
};

// What was read and found, and what was left out and why.
struct SpiceStepSummary {
  std::size_t rover_segments = 0, attitude_segments = 0, sites = 0;
  bool has_landing_site = false;
  std::size_t other_bodies = 0;      // segments of bodies, centres and frames that are not asked for
  std::size_t other_types = 0;       // segments of a type that is not read
  std::size_t states = 0;            // of the rover
  std::size_t without_attitude = 0;  // states, where there are attitudes at other times
  std::size_t gaps = 0;
  std::size_t corrections = 0;          // jumps after a drive and a rest, of which steps are made:
  std::size_t jumps_without_drive = 0;  // jumps that no drive and no rest precede
  std::size_t too_short = 0, too_long = 0, off_axis = 0;
  std::size_t no_slip = 0;       // the ratio is outside of what a slip can be
  std::size_t out_of_range = 0;  // a time or a place that no table of steps may have
  std::size_t repeated = 0;      // in several files
  std::size_t steps = 0, steps_with_attitude = 0;
};

struct SpiceSteps {
  std::vector<SlipStep> steps;  // by rising time
  SpiceStepSummary summary;
};

// There must be positions of the rover; with attitudes also its clock. Errors: unreadable_data with the file
// and the byte or line of what is wrong in it.
Result<SpiceSteps> steps_from_spice(std::span<const KernelBytes> files, const SpiceStepOptions& options = {});

}  // namespace slipway::steps
