#include "research/validation/laboratory/ding_tests.h"

#include <fmt/format.h>

#include "api/chart/chart.h"
#include "research/validation/laboratory/laboratory_soil.h"
#include "research/validation/report/csv_table.h"
#include "research/validation/report/statistics.h"
#include "sim/wheel/entry_angle.h"
#include "sim/wheel/slip_ratio.h"

namespace slipway::validation {
namespace {

constexpr double kLoad_n = 80.0;

std::string percent(double predicted, double measured, std::vector<double>& errors) {
  if (measured == 0.0) return "-";
  errors.push_back(predicted / measured - 1.0);
  return fmt::format("{:+.0f} %", 100.0 * errors.back());
}

api::Chart panel(const std::vector<DingTest>& tests, const DingModel& model, const char* title,
                 double RigReading::*quantity) {
  api::Chart chart;
  chart.title = title;
  chart.x.title = "slip";
  chart.y.title = title;
  chart.series = {{"measured, smooth", api::ChartMark::kPoints, {}, {}, 0},
                  {"measured, lugged", api::ChartMark::kPoints, {}, {}, 1}};
  for (const DingTest& test : tests) {
    api::ChartSeries& series = chart.series[test.lugged ? 1 : 0];
    series.x.push_back(test.slip);
    series.y.push_back(test.measured.*quantity);
  }
  for (const bool lugged : {false, true}) {
    api::ChartSeries line{lugged ? "predicted, lugged" : "predicted, smooth",
                          api::ChartMark::kLine,
                          {},
                          {},
                          lugged ? std::size_t{1} : 0};
    for (int k = 0; k <= 30; ++k) {
      const auto reading = model(lugged, 0.02 * k);
      if (!reading) continue;
      line.x.push_back(0.02 * k);
      line.y.push_back((*reading).*quantity);
    }
    chart.series.push_back(line);
  }
  return chart;
}

}  // namespace

Result<std::vector<DingTest>> load_ding_tests(const std::filesystem::path& csv) {
  const auto table = CsvTable::read(csv, {.numbers = {"slip", "drawbar_pull_n", "sinkage_mm", "torque_nm"},
                                          .numbers_or_empty = {},
                                          .texts = {"wheel"}});
  if (!table) return fail(table.error());
  std::vector<DingTest> tests;
  for (std::size_t k = 0; k < table->rows(); ++k)
    tests.push_back({table->text(k, "wheel") == "lugged",
                     table->number(k, "slip"),
                     {table->number(k, "drawbar_pull_n"), table->number(k, "sinkage_mm"),
                      table->number(k, "torque_nm")}});
  return tests;
}

sim::Soil ding_sand() {
  sim::Soil sand = laboratory_soil({15'600.0, 2'407'400.0, 1.1}, 250.0, 31.9, 0.011, 0.18, 0.32);
  sand.density_kg_m3 = 1600.0;
  sand.gravity_m_s2 = 9.81;
  return sand;
}

std::optional<RigReading> ding_reading(const sim::Soil& sand, bool lugged, bool grousers, double rim_friction,
                                       double slip) {
  sim::WheelGeometry wheel{.radius_m = 0.15735, .width_m = 0.165};
  if (lugged && grousers) wheel.grousers = {0.01, 30.0};
  if (!lugged) wheel.rim_friction = rim_friction;
  const sim::WheelMotion motion{sim::speed_ratio_from_slip(slip), 0.0};
  const auto theta = sim::balanced_entry_angle_rad(wheel, sand, kLoad_n, motion);
  if (!theta) return std::nullopt;
  const sim::WheelForces f = sim::wheel_forces(wheel, sand, *theta, motion);
  return RigReading{f.drawbar_pull_n, 1e3 * sim::sinkage_m(wheel.radius_m, *theta), f.torque_nm};
}

DingErrors add_ding_rows(const std::vector<DingTest>& tests, bool lugged, const DingModel& model,
                         Report& report) {
  std::vector<double> pull, sinkage, torque;
  for (const DingTest& test : tests) {
    if (test.lugged != lugged) continue;
    const RigReading& measured = test.measured;
    const auto predicted = model(test.lugged, test.slip);
    const std::string name = fmt::format("{}, slip {:.1f}", test.wheel(), test.slip);
    if (!predicted) {
      report.rows.push_back({test.wheel(), fmt::format("{:.1f}", test.slip), "sunk to the axle"});
      continue;
    }
    report.rows.push_back(
        {test.wheel(), fmt::format("{:.1f}", test.slip), fmt::format("{:g}", measured.pull_n),
         fmt::format("{:.1f}", predicted->pull_n), percent(predicted->pull_n, measured.pull_n, pull),
         fmt::format("{:g}", measured.sinkage_mm), fmt::format("{:.1f}", predicted->sinkage_mm),
         percent(predicted->sinkage_mm, measured.sinkage_mm, sinkage),
         fmt::format("{:g}", measured.torque_nm), fmt::format("{:.2f}", predicted->torque_nm),
         percent(predicted->torque_nm, measured.torque_nm, torque)});
    report.cases.push_back({name, "drawbar_pull", "N", measured.pull_n, predicted->pull_n});
    report.cases.push_back({name, "sinkage", "mm", measured.sinkage_mm, predicted->sinkage_mm});
    report.cases.push_back({name, "torque", "N m", measured.torque_nm, predicted->torque_nm});
  }
  return {median_abs(pull), median_abs(sinkage), median_abs(torque)};
}

std::string ding_plot(const std::vector<DingTest>& tests, const DingModel& model, const std::string& title) {
  const api::Chart panels[] = {panel(tests, model, "drawbar pull, N", &RigReading::pull_n),
                               panel(tests, model, "sinkage, mm", &RigReading::sinkage_mm),
                               panel(tests, model, "torque, N m", &RigReading::torque_nm)};
  return api::draw_charts(title, panels);
}

}  // namespace slipway::validation
