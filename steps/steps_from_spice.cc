#include "steps/steps_from_spice.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "steps/kernel_set.h"
#include "steps/slip_steps_csv.h"
#include "steps/step_columns.h"
#include "steps/step_finder.h"

namespace slipway::steps {
namespace {

// Clockwise from north, in [0, 2 pi).
double azimuth_rad(const Eigen::Vector3d& north_east_down) {
  const double angle = std::atan2(north_east_down.y(), north_east_down.x());
  return angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle;
}

// The body's axes in the level frame: rows of the matrix that turns the level frame into the body's.
struct BodyAxes {
  explicit BodyAxes(const Eigen::Quaterniond& q) : matrix(q.toRotationMatrix()) {}
  Eigen::Matrix3d matrix;

  Eigen::Vector3d forward() const { return matrix.row(0); }
  Eigen::Vector3d down() const { return matrix.row(2); }
  double pitch_rad() const { return std::asin(std::clamp(-matrix(0, 2), -1.0, 1.0)); }
  double roll_rad() const { return std::asin(std::clamp(matrix(1, 2), -1.0, 1.0)); }
};

class StepMaker {
 public:
  StepMaker(const KernelSet& kernels, const SpiceStepOptions& options, SpiceStepSummary& summary)
      : kernels_(kernels), options_(options), summary_(summary) {}

  // Nothing where it is left out, which is counted.
  std::optional<SlipStep> make(const FoundStep& found, int site) {
    ++summary_.corrections;
    SlipStep step;
    step.odometry_m = found.driven_m.norm();
    if (step.odometry_m < options_.shortest_m) return ++summary_.too_short, std::nullopt;
    if (step.odometry_m > options_.longest_m) return ++summary_.too_long, std::nullopt;
    const Eigen::Vector3d along = found.driven_m / step.odometry_m;
    step.slip = -found.correction_m.dot(along) / step.odometry_m;
    if (step.slip < kLowestSlip || step.slip > kHighestSlip) return ++summary_.no_slip, std::nullopt;
    Eigen::Vector3d down = Eigen::Vector3d::UnitZ();
    if (found.start.attitude && found.end.attitude) {
      const BodyAxes end(*found.end.attitude);
      if (std::abs(end.forward().dot(along)) < std::cos(options_.widest_off_axis_rad))
        return ++summary_.off_axis, std::nullopt;
      down = end.down();
      write_attitude(BodyAxes(*found.start.attitude), end, along, step);
    }
    // Across the travel, to its right, on the plane on which the body stands.
    step.side_m = found.correction_m.dot(down.cross(along).normalized());
    write_place(found, site, step);
    if (!may_be_in_a_table(step)) return ++summary_.out_of_range, std::nullopt;
    return step;
  }

 private:
  // Whether the reader of tables would take it: a kernel may say anything.
  static bool may_be_in_a_table(const SlipStep& step) {
    const auto within = [](StepColumn column, double value) {
      return value >= kStepColumnRows[column].lowest && value <= kStepColumnRows[column].highest;
    };
    return within(kSol, step.sol) && within(kSide, *step.side_m) && within(kDriveTime, *step.drive_s) &&
           within(kSiteNorth, *step.site_north_m) && within(kSiteEast, *step.site_east_m) &&
           within(kSiteDown, *step.site_down_m);
  }

  static void write_attitude(const BodyAxes& start, const BodyAxes& end, const Eigen::Vector3d& along,
                             SlipStep& step) {
    const bool backward = end.forward().dot(along) < 0.0;
    const double sense = backward ? -1.0 : 1.0;
    step.attitude = StepAttitude::kCk;
    step.backward = backward;
    step.climb_pitch_start_rad = sense * start.pitch_rad();
    step.climb_pitch_end_rad = sense * end.pitch_rad();
    step.roll_start_rad = sense * start.roll_rad();
    step.roll_end_rad = sense * end.roll_rad();
    step.heading_rad = azimuth_rad(end.forward());
  }

  void write_place(const FoundStep& found, int site, SlipStep& step) const {
    step.et_s = found.end.et_s;
    step.sol = static_cast<int>(std::floor((step.et_s - options_.sol_zero_et_s) / options_.sol_length_s));
    step.site = site;
    step.site_north_m = found.start.position_m.x();
    step.site_east_m = found.start.position_m.y();
    step.site_down_m = found.start.position_m.z();
    step.drive_s = found.drive_s;
    const Eigen::Vector3d way = found.end.position_m - found.start.position_m;
    step.path_pitch_rad = std::atan2(-way.z(), std::hypot(way.x(), way.y()));
    step.course_rad = azimuth_rad(way);
    const auto offset = kernels_.offset_of_site(site);
    if (!offset || !kernels_.landing_m()) return;
    // Equidistant cylindrical, planetocentric; the level frame is taken for that of the landing site.
    const auto& [x, y, z] = *kernels_.landing_m();
    const double radius_m = std::hypot(x, y, z);
    const double latitude = std::atan2(z, std::hypot(x, y));
    const double north_m = (*offset)[0] + *step.site_north_m, east_m = (*offset)[1] + *step.site_east_m;
    const double map_x_m =
        options_.map_radius_m * (std::atan2(y, x) + east_m / (radius_m * std::cos(latitude)));
    const double map_y_m = options_.map_radius_m * (latitude + north_m / radius_m);
    // A landing site at a pole or in the planet's centre has no such map.
    const double widest_m = kStepColumnRows[kXEqc].highest;
    if (!(std::abs(map_x_m) <= widest_m && std::abs(map_y_m) <= widest_m)) return;
    step.x_eqc_m = map_x_m;
    step.y_eqc_m = map_y_m;
  }

  const KernelSet& kernels_;
  const SpiceStepOptions& options_;
  SpiceStepSummary& summary_;
};

// The states of a segment with their attitudes; whether there is any of them.
bool place_states(const SpkSegment& segment, const KernelSet& kernels, std::vector<PlacedState>& states) {
  bool some = false;
  states.clear();
  states.reserve(segment.states.size());
  for (const SpkState& each : segment.states) {
    const auto& [north, east, down] = each.position_m;
    states.push_back({each.et_s, Eigen::Vector3d(north, east, down), kernels.attitude(each.et_s)});
    some = some || states.back().attitude;
  }
  return some;
}

void sort_and_drop_repeated(std::vector<SlipStep>& steps, SpiceStepSummary& summary) {
  std::stable_sort(steps.begin(), steps.end(),
                   [](const SlipStep& a, const SlipStep& b) { return a.et_s < b.et_s; });
  const std::size_t all = steps.size();
  steps.erase(std::unique(steps.begin(), steps.end(),
                          [](const SlipStep& a, const SlipStep& b) {
                            return a.et_s == b.et_s && a.site == b.site && a.odometry_m == b.odometry_m;
                          }),
              steps.end());
  summary.repeated = all - steps.size();
  summary.steps = steps.size();
  summary.steps_with_attitude = static_cast<std::size_t>(std::count_if(
      steps.begin(), steps.end(), [](const SlipStep& s) { return s.attitude == StepAttitude::kCk; }));
}

}  // namespace

Result<SpiceSteps> steps_from_spice(std::span<const KernelBytes> files, const SpiceStepOptions& options) {
  SpiceSteps out;
  const auto kernels = KernelSet::read(files, options, out.summary);
  if (!kernels) return fail(kernels.error());
  StepMaker maker(*kernels, options, out.summary);
  std::vector<PlacedState> states;
  for (const SpkSegment& segment : kernels->rover()) {
    out.summary.states += segment.states.size();
    // A segment of times for which no attitude was published is read as if there were none at all.
    const bool with_attitudes = place_states(segment, *kernels, states);
    for (const FoundStep& found : find_steps(states, with_attitudes, options, out.summary))
      if (auto step = maker.make(found, options.site_zero - segment.centre))
        out.steps.push_back(std::move(*step));
  }
  sort_and_drop_repeated(out.steps, out.summary);
  return out;
}

}  // namespace slipway::steps
