#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "api/files/drive_table/campaign_source.h"
#include "campaign/run_campaign.h"
#include "core/angle.h"
#include "research/validation/mars/comparisons.h"
#include "research/validation/report/statistics.h"

namespace slipway::validation {
namespace {

using sim::SensorReading;

constexpr double kSol2143Slip = 0.65, kSol2143Sinkage_mm = 50.0, kSpiritSlip = 0.9;
constexpr double kStarting_s = 4.0;  // time of the acceleration at the start

// Simulates drives of a shipped table with true values in place of the sensors' readings.
Result<std::map<std::string, campaign::MadeDrive>> drives_of(const std::string& name,
                                                             const std::filesystem::path& data,
                                                             const api::Catalogue& catalogue) {
  auto loaded = api::load_campaign_table(name, data, catalogue);
  if (!loaded) return fail(loaded.error());
  loaded->table.sensors = {};
  std::map<std::string, campaign::MadeDrive> drives;
  NoProgress progress;
  for (const campaign::TableDrive& drive : campaign::expand(loaded->table)) {
    campaign::MadeDrive made = campaign::make_drive(loaded->table, drive, &sim::simulate_drive, progress);
    if (!made.drive) return fail(made.drive.error());
    drives.emplace(drive.id, std::move(made));
  }
  return drives;
}

Result<const campaign::MadeDrive*> find(const std::map<std::string, campaign::MadeDrive>& drives,
                                        const std::string& id) {
  const auto drive = drives.find(id);
  if (drive == drives.end())
    return fail(ErrorCode::kUnreadableData, fmt::format("the tables have no drive {}", id));
  return &drive->second;
}

std::size_t wheel_of(const sim::RoverModel& rover, std::string_view name) {
  for (std::size_t k = 0; k < rover.wheels.size(); ++k)
    if (rover.wheels[k].name == name) return k;
  return 0;
}

bool drives_on(const SensorReading& reading) {
  return reading.sample.driving && reading.sample.time_s > kStarting_s;
}

// Rounds to digits that are the same on all machines.
double rounded(double value, double step) {
  return step * std::round(value / step);
}

struct Climb {
  double slip = 0.0;
  std::array<double, 3> sinkage_mm{}, torque_nm{};  // maxima of the front, middle and rear wheels
  double pitch_deg = 0.0, ends_x_m = 0.0;
};

// The maxima until the crest at x = 0; a positive pitch has the front downhill.
Climb climb_of(const campaign::MadeDrive& made, const sim::RoverModel& rover) {
  Climb climb;
  const std::array<std::size_t, 3> wheels{wheel_of(rover, "rf"), wheel_of(rover, "rm"),
                                          wheel_of(rover, "rr")};
  for (const SensorReading& reading : made.readings) {
    climb.ends_x_m = reading.sample.p_MB.x();
    if (!drives_on(reading) || reading.sample.p_MB.x() > 0.0) continue;
    climb.slip = std::max(climb.slip, reading.sample.slip_ratio);
    climb.pitch_deg = std::max(climb.pitch_deg, deg_from_rad(reading.sample.attitude.pitch_rad));
    for (std::size_t i = 0; i < wheels.size(); ++i) {
      const sim::WheelState& wheel = reading.sample.wheels[wheels[i]];
      climb.sinkage_mm[i] = std::max(climb.sinkage_mm[i], 1e3 * wheel.sinkage_m);
      climb.torque_nm[i] = std::max(climb.torque_nm[i], std::abs(wheel.torque_nm));
    }
  }
  return climb;
}

void add_ripple(const campaign::MadeDrive& made, const sim::RoverModel& rover, Report& report) {
  const Climb climb = climb_of(made, rover);
  const auto row = [&](const char* what, const char* published, std::string ours) {
    report.rows.push_back({"Opportunity, sol 2143", what, published, std::move(ours)});
  };
  row("maximum slip going up, %", "up to 65", fmt::format("{:.0f}", 100.0 * climb.slip));
  row("maximum sinkage going up, mm: front (downslope), middle, rear", "up to about 50",
      fmt::format("{:.0f}, {:.0f}, {:.0f}", climb.sinkage_mm[0], climb.sinkage_mm[1], climb.sinkage_mm[2]));
  row("maximum torque going up, N m: front, middle, rear", "maximum in front",
      fmt::format("{:.1f}, {:.1f}, {:.1f}", climb.torque_nm[0], climb.torque_nm[1], climb.torque_nm[2]));
  row("pitch going up, deg", "positive: front downhill", fmt::format("up to {:+.0f}", climb.pitch_deg));
  const bool crosses = climb.ends_x_m > 2.5;
  row("crosses the ripple", "yes", crosses ? "yes" : "no");
  report.bands.push_back({"sol 2143: maximum slip", rounded(climb.slip, 0.01), 0.6, 0.7});
  report.bands.push_back(
      {"sol 2143: maximum sinkage of a front wheel, mm", rounded(climb.sinkage_mm[0], 1.0), 45, 55});
  report.bands.push_back({"sol 2143: that of a rear wheel, mm", rounded(climb.sinkage_mm[2], 1.0), 0, 45});
  report.bands.push_back({"sol 2143: crosses", crosses ? 1.0 : 0.0, 1, 1});
  report.cases.push_back({"sol 2143", "greatest slip", "1", kSol2143Slip, climb.slip});
  report.cases.push_back({"sol 2143", "greatest sinkage", "mm", kSol2143Sinkage_mm, climb.sinkage_mm[0]});
}

// The distance between a wheel's positions at the start and at the end.
double carried_m(const sim::DynamicDrive& drive, const sim::WheelModel& wheel) {
  const auto at = [&](const Pose2& pose) {
    const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
    return Eigen::Vector2d(pose.x_m + c * wheel.position_m.x() - s * wheel.position_m.y(),
                           pose.y_m + s * wheel.position_m.x() + c * wheel.position_m.y());
  };
  return (at(drive.final) - at(drive.start)).norm();
}

// side is 1 where a rover that turns about its dead right front wheel yaws to the left, and -1 to the right.
void add_yaw(const char* way, double side, const sim::DynamicDrive& drive, const sim::RoverModel& rover,
             Report& report) {
  const double yaw_deg = deg_from_rad(drive.final.yaw_rad - drive.start.yaw_rad);
  report.rows.push_back({fmt::format("Spirit, {}", way),
                         "yaw on level ground, deg; dead wheel and left front carried, m",
                         "about the dead wheel",
                         fmt::format("{:+.0f}; {:.1f} and {:.1f}", yaw_deg,
                                     carried_m(drive, rover.wheels[wheel_of(rover, "rf")]),
                                     carried_m(drive, rover.wheels[wheel_of(rover, "lf")]))});
  report.bands.push_back({fmt::format("Spirit, {}: yaw to the dead wheel's side, deg", way),
                          rounded(side * yaw_deg, 1.0), 10, 90});
}

double middle_slip(const campaign::MadeDrive& made) {
  std::vector<double> slips;
  for (const SensorReading& reading : made.readings)
    if (drives_on(reading)) slips.push_back(reading.sample.slip_ratio);
  return median(slips);
}

void add_lift(const campaign::MadeDrive& made, const sim::RoverModel& rover, Report& report) {
  std::vector<std::string> lifted;
  for (const sim::DriveEvent& event : made.drive->events)
    if (event.kind == sim::DriveEventKind::kLiftOff)
      lifted.push_back(fmt::format("{} after {:.0f} s",
                                   rover.wheels[static_cast<std::size_t>(event.wheel)].name, event.time_s));
  const bool right_middle = lifted.size() == 1 && lifted.front().starts_with("rm");
  report.rows.push_back({"Spirit, forward, pushing it", "wheels that lift off", "right middle, at times",
                         lifted.empty() ? "none" : fmt::format("{}", fmt::join(lifted, ", "))});
  report.bands.push_back({"Spirit: only the right middle wheel lifts", right_middle ? 1.0 : 0.0, 1, 1});
}

}  // namespace

Result<Report> artemis_cases(const std::filesystem::path& data) {
  const auto catalogue = api::load_catalogue(data);
  if (!catalogue) return fail(catalogue.error());
  const sim::RoverModel& rover = *catalogue->rovers.at("mer-class");
  auto drives = drives_of("opportunity_sol_2143", data, *catalogue);
  if (!drives) return fail(drives.error());
  auto spirit = drives_of("spirit_dead_wheel", data, *catalogue);
  if (!spirit) return fail(spirit.error());
  drives->merge(*spirit);
  const auto ripple = find(*drives, "backward_over_ripple"), dragging = find(*drives, "yaw_dragging"),
             pushing = find(*drives, "yaw_pushing"), slope = find(*drives, "slip_up_the_slope"),
             lifts = find(*drives, "right_middle_lifts");
  for (const auto& drive : {ripple, dragging, pushing, slope, lifts})
    if (!drive) return fail(drive.error());

  Report report;
  report.title = "What happened to Opportunity and Spirit";
  report.source = "ARTEMIS paper, section 2.3: what was observed of the rovers, and what ARTEMIS reproduced";
  report.peers =
      "ARTEMIS, on soils chosen to be like the observed ones, reproduces the same by its authors' "
      "word, without numbers of its own";
  report.columns = {"drive", "what", "published", "predicted"};
  add_ripple(**ripple, rover, report);
  add_yaw("backward, dragging it", 1.0, *(*dragging)->drive, rover, report);
  add_yaw("forward, pushing it", -1.0, *(*pushing)->drive, rover, report);
  const double slip = middle_slip(**slope);
  report.rows.push_back(
      {"Spirit, up a slope of 8 deg", "median slip, %", "about 90", fmt::format("{:.0f}", 100.0 * slip)});
  report.bands.push_back({"Spirit: median slip up the slope", rounded(slip, 0.01), 0.85, 0.95});
  report.cases.push_back({"Spirit up a slope", "median slip", "1", kSpiritSlip, slip});
  add_lift(**lifts, rover, report);
  report.notes.push_back(
      "This is a fit, not a prediction: the ripple's sand and its slip sinkage were chosen to "
      "match 65 % and 5 cm. With slightly less cohesion (800 instead of 900 Pa) the rover digs in "
      "and does not cross. The slope was chosen for about 90 %. The model itself gives which "
      "wheels are worst and which way the rover yaws.");
  report.notes.push_back(
      "The middle wheels sink deepest here and have the maximum torque, a little before the front "
      "ones; the paper shows a front wheel only. This rover's rocker and bogie are assumed.");
  report.notes.push_back(
      "In both drives on level ground the rover turns about the dead wheel as Spirit did, and the "
      "dead wheel stays where it is when it is pushed. Nothing steers against the turn, as "
      "Spirit's drivers did.");
  report.notes.push_back(
      "The right middle wheel lifts where the soil holds wheels with more than their load, since "
      "the bogie's pivot is high: on the bundled dense soil at Spirit (15 kPa of cohesion), and "
      "with its friction angle from about 10 kPa on; with 5 kPa or less it does not lift, even on "
      "slopes or before bumps. The soil is chosen for that. The wheel stays up for the rest of the "
      "drive; the paper says that Spirit's rose during certain drive events. In "
      "such soil the laws give a dragged locked wheel a negative load at times, as no real soil "
      "does; dragging is therefore shown on another soil.");
  report.notes.push_back(
      "One case that ARTEMIS lists is left out here: sliding down slopes, which "
      "docs/guide/examples/sliding.json drives.");
  return report;
}

}  // namespace slipway::validation
