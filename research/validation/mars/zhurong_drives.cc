#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "api/chart/chart.h"
#include "api/files/catalogue.h"
#include "gap/estimate/least_squares.h"
#include "research/validation/mars/comparisons.h"
#include "sim/quasi_static/rover_balance.h"
#include "sim/wheel/entry_angle.h"
#include "sim/wheel/slip_ratio.h"

namespace slipway::validation {
namespace {

constexpr double kEarthGravity_m_s2 = 9.81;
constexpr sim::WheelGeometry kWheel{.radius_m = 0.1475, .width_m = 0.2};

// Table 4: mean currents at zero slip on JLU Mars 2, dense. +Y is the left side, and 1 is the front.
constexpr std::array kNames{"lf", "lm", "lr", "rf", "rm", "rr"};
constexpr std::array kMeasured_a{0.125, 0.100, 0.128, 0.108, 0.096, 0.110};

// Shifts of the rover's geometry that change the load of the six wheels.
struct LoadShift {
  double com_x_m = 0.0, com_y_m = 0.0, bogie_x_m = 0.0;
};

// The loads of the level rover's wheels at rest.
std::vector<double> resting_loads_n(sim::RoverModel rover, const sim::Soil& soil, const LoadShift& shift) {
  rover.com_m += Eigen::Vector3d(shift.com_x_m, shift.com_y_m, 0.0);
  rover.suspension.bogie_pivot_m.x() += shift.bogie_x_m;
  const sim::PerWheel<sim::Soil> soils(rover.wheels.size(), soil);
  const sim::Stance stance = sim::stance_on_plane(rover, {});
  sim::RoverBalance balance(rover, kEarthGravity_m_s2, stance, soils, {.speed_m_s = rover.cruise_speed_m_s});
  const auto loads = balance.resting_loads_n();
  return {loads.begin(), loads.end()};
}

double torque_nm(const sim::Soil& soil, double load_n) {
  const auto theta = sim::balanced_entry_angle_rad(kWheel, soil, load_n, {1.0, 0.0});
  return theta ? sim::wheel_forces(kWheel, soil, *theta, {1.0, 0.0}).torque_nm : 0.0;
}

// The currents by each wheel's own load. The gain from torque to current is set so that their mean is the
// measured one, since the paper's own lacks a gear ratio that it does not print.
std::vector<double> currents_a(const sim::RoverModel& rover, const sim::Soil& soil, const LoadShift& shift) {
  std::vector<double> currents;
  for (const double load : resting_loads_n(rover, soil, shift)) currents.push_back(torque_nm(soil, load));
  const double mean = std::accumulate(currents.begin(), currents.end(), 0.0);
  const double measured = std::accumulate(kMeasured_a.begin(), kMeasured_a.end(), 0.0);
  for (double& current : currents) current *= measured / mean;
  return currents;
}

double mean_abs_error(const std::vector<double>& predicted) {
  double sum = 0.0;
  for (std::size_t k = 0; k < predicted.size(); ++k) sum += std::abs(predicted[k] / kMeasured_a[k] - 1.0);
  return sum / static_cast<double>(predicted.size());
}

using Lever = double LoadShift::*;

// The shift of these quantities that fits the six currents best.
Result<LoadShift> explain(const sim::RoverModel& rover, const sim::Soil& soil,
                          const std::vector<Lever>& levers) {
  std::vector<gap::Unknown> unknowns;
  for (const Lever lever : levers) {
    const double farthest = lever == &LoadShift::bogie_x_m ? 0.2 : 0.3;
    unknowns.push_back({.name = "shift",
                        .start = 0.0,
                        .lowest = -farthest,
                        .highest = farthest,
                        .step_scale = 0.02,
                        .prior = {}});
  }
  const auto shift_of = [&levers](std::span<const double> x) {
    LoadShift shift;
    for (std::size_t k = 0; k < levers.size(); ++k) shift.*levers[k] = x[k];
    return shift;
  };
  NoProgress progress;
  const auto fit = gap::fit_least_squares(
      unknowns, kMeasured_a.size(),
      [&](std::span<const double> x, std::span<double> r) {
        const std::vector<double> predicted = currents_a(rover, soil, shift_of(x));
        for (std::size_t k = 0; k < r.size(); ++k) r[k] = predicted[k] / kMeasured_a[k] - 1.0;
        return true;
      },
      {.tolerance = 1e-9, .residual_std_known = false}, progress);
  if (!fit) return fail(fit.error());
  return shift_of(fit->estimate);
}

double squares(const std::vector<double>& predicted) {
  double sum = 0.0;
  for (std::size_t k = 0; k < predicted.size(); ++k) sum += std::pow(predicted[k] / kMeasured_a[k] - 1.0, 2);
  return sum;
}

// The same rover with its centre of mass above the mean of the wheels' places and the bogies' pivots midway
// between their wheels, so that all wheels have the same load on level ground.
sim::RoverModel with_even_loads(sim::RoverModel rover) {
  double all_m = 0.0, bogie_m = 0.0;
  int of_bogie = 0;
  for (const sim::WheelModel& wheel : rover.wheels) {
    all_m += wheel.position_m.x() / static_cast<double>(rover.wheels.size());
    if (wheel.name == "lf" || wheel.name == "rf") continue;
    bogie_m += wheel.position_m.x();
    ++of_bogie;
  }
  rover.com_m.x() = all_m;
  rover.com_m.y() = 0.0;
  rover.suspension.bogie_pivot_m.x() = bogie_m / of_bogie;
  return rover;
}

// The percentage by which a shift of the load reduces the sum of the six squared errors of equal loads. The
// gain is free in both.
double percent_explained(const std::vector<double>& currents) {
  const double mean = std::accumulate(kMeasured_a.begin(), kMeasured_a.end(), 0.0) / kMeasured_a.size();
  const double even = squares(std::vector<double>(kMeasured_a.size(), mean));
  return 100.0 * (1.0 - squares(currents) / even);
}

std::vector<std::string> current_row(const std::string& name, const std::vector<double>& currents) {
  std::vector<std::string> row{name};
  for (std::size_t k = 0; k < currents.size(); ++k)
    row.push_back(
        fmt::format("{:.3f} ({:+.0f} %)", currents[k], 100.0 * (currents[k] / kMeasured_a[k] - 1.0)));
  row.push_back(fmt::format("{:.1f} %", 100.0 * mean_abs_error(currents)));
  return row;
}

// The pull of six wheels. The following wheels run in the leading wheels' tracks and push no heap of soil.
std::optional<double> six_wheel_pull_n(sim::Soil soil, double load_n, double slip, double bulldozing) {
  const sim::WheelMotion motion{sim::speed_ratio_from_slip(slip), 0.0};
  double pull = 0.0;
  for (const int wheels : {2, 4}) {
    soil.bulldozing = wheels == 2 ? bulldozing : 0.0;
    const auto theta = sim::balanced_entry_angle_rad(kWheel, soil, load_n, motion);
    if (!theta) return std::nullopt;
    pull += wheels * sim::wheel_forces(kWheel, soil, *theta, motion).drawbar_pull_n;
  }
  return pull;
}

// The ends of the measured ranges as the paper's text gives them.
struct PullPoint {
  const char* soil;
  double slip, pull_n;
  bool top;
};
constexpr std::array kPulls{
    PullPoint{"jlu_mars_2_dense", 0.04, 20.0, false}, PullPoint{"jlu_mars_2_dense", 0.91, 500.0, true},
    PullPoint{"jlu_mars_3_dense", 0.13, 200.0, false}, PullPoint{"jlu_mars_3_dense", 0.84, 490.0, true}};

sim::Soil on_earth(sim::Soil soil) {
  soil.gravity_m_s2 = kEarthGravity_m_s2;
  return soil;
}

std::string pull_plot(const api::Catalogue& catalogue, double load_n, const std::string& title) {
  api::Chart chart;
  chart.title = title;
  chart.x.title = "slip";
  chart.y.title = "drawbar pull of six wheels, N";
  std::size_t colour = 0;
  for (const char* name : {"jlu_mars_2_dense", "jlu_mars_3_dense"}) {
    const sim::Soil soil = on_earth(catalogue.soils.find(name)->second.mean);
    api::ChartSeries points{std::string(name) + ", measured ends", api::ChartMark::kPoints, {}, {}, colour};
    for (const PullPoint& point : kPulls)
      if (std::string_view(point.soil) == name) {
        points.x.push_back(point.slip);
        points.y.push_back(point.pull_n);
      }
    chart.series.push_back(points);
    api::ChartSeries line{
        std::string(name) + ", predicted, leaders bulldozing", api::ChartMark::kLine, {}, {}, colour++};
    for (int k = 0; k <= 47; ++k) {
      line.x.push_back(0.02 * k);
      line.y.push_back(six_wheel_pull_n(soil, load_n, 0.02 * k, 1.0).value_or(std::nan("")));
    }
    chart.series.push_back(line);
  }
  return api::draw_charts(title, {&chart, 1});
}

// The report with its title, source and columns, without rows.
Report zhurong_wheels_report() {
  Report report;
  report.title = "Zhurong's six currents at zero slip, each wheel by its own load";
  report.source =
      "Zhurong paper, Table 4 (JLU Mars 2 dense); loads by the statics of the shipped zhurong-class rover";
  report.peers = "the paper averages the load: 0.114 A for every wheel";
  report.columns = {"load split", "lf +Y1", "lm +Y2", "lr +Y3",
                    "rf -Y1",     "rm -Y2", "rr -Y3", "mean abs error"};
  return report;
}

}  // namespace

Result<Report> zhurong_wheels(const std::filesystem::path& data) {
  const auto catalogue = api::load_catalogue(data);
  if (!catalogue) return fail(catalogue.error());
  const sim::RoverModel& rover = *catalogue->rovers.at("zhurong-class");
  const sim::Soil soil = on_earth(catalogue->soils.find("jlu_mars_2_dense")->second.mean);
  const Lever forward = &LoadShift::com_x_m, left = &LoadShift::com_y_m, pivots = &LoadShift::bogie_x_m;
  const auto centre = explain(rover, soil, {forward, left}),
             both = explain(rover, soil, {forward, left, pivots});
  // Each cause alone starts from equally loaded wheels, so that the part that the file's own geometry
  // explains is not counted.
  const sim::RoverModel alike = with_even_loads(rover);
  const auto sides = explain(alike, soil, {left}), rows = explain(alike, soil, {pivots}),
             fore_aft = explain(alike, soil, {forward, pivots});
  for (const auto& shift : {centre, both, sides, rows, fore_aft})
    if (!shift) return fail(shift.error());
  const std::vector<double> even(kMeasured_a.size(), 0.114);
  const std::vector<double> filed = currents_a(rover, soil, {}), shifted = currents_a(rover, soil, *centre),
                            best = currents_a(rover, soil, *both);
  const double of_rows = percent_explained(currents_a(alike, soil, *rows)),
               of_sides = percent_explained(currents_a(alike, soil, *sides)),
               of_fore_aft = percent_explained(currents_a(alike, soil, *fore_aft));
  Report report = zhurong_wheels_report();
  std::vector<std::string> measured{"measured, A"};
  for (const double current : kMeasured_a) measured.push_back(fmt::format("{:.3f}", current));
  measured.push_back("-");
  report.rows = {measured,
                 current_row("equal loads, as in the paper", even),
                 current_row("the rover's file unchanged", filed),
                 current_row("centre of mass shifted", shifted),
                 current_row("centre of mass and bogie pivots shifted", best),
                 current_row("equal loads, then mass to a side", currents_a(alike, soil, *sides)),
                 current_row("equal loads, then bogie pivots back", currents_a(alike, soil, *rows))};
  for (std::size_t k = 0; k < best.size(); ++k)
    report.cases.push_back({kNames[k], "current", "A", kMeasured_a[k], best[k]});
  report.notes = {
      fmt::format("A centre of mass {:+.0f} mm forward and {:+.0f} mm to the left of the file's explains "
                  "the differences between the sides and of the front; alone it leaves {:.1f} %.",
                  1e3 * centre->com_x_m, 1e3 * centre->com_y_m, 100.0 * mean_abs_error(shifted)),
      fmt::format("No centre of mass unloads the middle wheels of a rocker-bogie. This needs the bogies' "
                  "pivots {:.0f} mm farther back than the file's assumed place (then the centre of mass is "
                  "{:+.0f} mm forward and {:+.0f} mm left). The flight geometry is not published; three "
                  "numbers and a gain are fitted to six currents.",
                  -1e3 * both->bogie_x_m, 1e3 * both->com_x_m, 1e3 * both->com_y_m),
      fmt::format("Each cause alone, starting from equally loaded wheels: the middle row's deficit (bogie "
                  "pivots {:.0f} mm back) removes {:.0f} % of the squared errors, mass {:.0f} mm to the "
                  "left removes {:.0f} %, and pivots and mass forward or back together remove {:.0f} %.",
                  -1e3 * rows->bogie_x_m, of_rows, 1e3 * sides->com_y_m, of_sides, of_fore_aft),
      "The gain from torque to current is calibrated on the measured mean, since the paper's "
      "constant lacks a gear ratio."};
  report.bands = {
      {"mean absolute error, the paper's even load, %", 100.0 * mean_abs_error(even), 9.8, 10.8},
      {"mean absolute error, load split by the vehicle, %", 100.0 * mean_abs_error(best), 0.0, 5.0},
      {"squared errors explained by the middle row's deficit less those by a side's load, %",
       of_rows - of_sides, 5.0, 100.0}};
  return report;
}

Result<Report> zhurong_pull(const std::filesystem::path& data) {
  const auto catalogue = api::load_catalogue(data);
  if (!catalogue) return fail(catalogue.error());
  const double load_n = catalogue->rovers.at("zhurong-class")->mass_kg * kEarthGravity_m_s2 / 6.0;
  Report report;
  report.title = "Zhurong's drawbar pull, six balanced wheels";
  report.source =
      "Zhurong paper, section 4.2: the ends of the measured ranges, 20 to 500 N at slip 0.04 to 0.91 on JLU "
      "Mars 2 "
      "dense, 200 to 490 N at 0.13 to 0.84 on JLU Mars 3 dense; nothing fitted";
  report.columns = {"soil", "slip", "measured N", "bare wheels N", "error", "leaders bulldozing N", "error"};
  for (const PullPoint& point : kPulls) {
    const sim::Soil soil = on_earth(catalogue->soils.find(point.soil)->second.mean);
    const double bare = six_wheel_pull_n(soil, load_n, point.slip, 0.0).value_or(0.0);
    const double pushed = six_wheel_pull_n(soil, load_n, point.slip, 1.0).value_or(0.0);
    const auto error = [&](double predicted) {
      return fmt::format("{:+.0f} %", 100.0 * (predicted / point.pull_n - 1.0));
    };
    report.rows.push_back({point.soil, fmt::format("{:.2f}", point.slip), fmt::format("{:.0f}", point.pull_n),
                           fmt::format("{:.0f}", bare), error(bare), fmt::format("{:.0f}", pushed),
                           error(pushed)});
    const std::string name = fmt::format("{}, slip {:.2f}", point.soil, point.slip);
    report.cases.push_back({name, "drawbar_pull", "N", point.pull_n, pushed});
    if (point.top && std::string_view(point.soil) == "jlu_mars_2_dense")
      report.bands.push_back({"error at the top end on JLU Mars 2 dense, leaders bulldozing, %",
                              100.0 * (pushed / point.pull_n - 1.0), -10.0, 10.0});
  }
  report.notes = {
      "At the low end the balanced wheels resist where the vehicle pulled: their compaction "
      "resistance, about 45 N a wheel, is more than the measured vehicle can have had. The paper's "
      "wheels have lugs, and dense simulant rebounds; neither K nor an exit angle was measured on "
      "the vehicle, and none is fitted here.",
      "Only the front pair pushes soil ahead, by the whole passive pressure (effect bulldozing); "
      "the following wheels run in its tracks."};
  report.plot = pull_plot(*catalogue, load_n, report.title);
  return report;
}

}  // namespace slipway::validation
