#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/chart/chart.h"
#include "research/validation/laboratory/laboratory_soil.h"
#include "research/validation/mars/comparisons.h"
#include "research/validation/report/csv_table.h"
#include "sim/single_wheel/zhurong_literal.h"
#include "sim/wheel/entry_angle.h"

namespace slipway::validation {
namespace {

using api::ChartMark;

constexpr sim::WheelGeometry kWheel{.radius_m = 0.1475, .width_m = 0.2};
constexpr double kLoad_n = 34.08 * 9.81;

std::string cell(const CsvTable& table, std::size_t row, const char* column, const char* format) {
  return table.empty(row, column) ? "-" : fmt::format(fmt::runtime(format), table.number(row, column));
}

sim::Soil soil_of(const CsvTable& table, std::size_t row) {
  return laboratory_soil(
      {1e3 * table.number(row, "k_c_kn"), 1e3 * table.number(row, "k_phi_kn"), table.number(row, "n")},
      1e3 * table.number(row, "cohesion_kpa"), table.number(row, "friction_angle_deg"),
      0.01 * table.number(row, "shear_modulus_cm"), table.number(row, "c1"), 0.32);
}

std::vector<api::Chart> empty_charts() {
  api::Chart torque, current;
  torque.title = "torque times k_I, by eq. A16 to A19";
  torque.x.title = "another reproduction of the paper";
  torque.y.title = "predicted";
  torque.diagonal = true;
  torque.series = {{"", ChartMark::kPoints, {}, {}, 0}};
  current.title = "motor current at zero slip";
  current.y = {"current, A", 0.0, {}, false, {}};
  current.series = {{"literal, entry angle of eq. A18", ChartMark::kPoints, {}, {}, 0},
                    {"balanced, carries the whole load", ChartMark::kPoints, {}, {}, 1}};
  return {torque, current};
}

// The report with its title, source and columns, without rows.
Report zhurong_states_report() {
  Report report;
  report.title = "Zhurong's current model at zero slip, literal and balanced";
  report.source =
      "Zhurong paper (Aerospace 2024, 11, 892), Table 1 and equations A16 to A19, and an independent "
      "reproduction of them; r 147.5 mm, b 200 mm, 34.08 kg x 9.81";
  report.peers = "the paper prints 0.114 A for JLU Mars 2 dense and measured 0.110 A";
  report.columns = {"state",
                    "sinkage A18 mm, reproduced",
                    "predicted",
                    "T k_I, reproduced",
                    "predicted",
                    "current A (literal, gear 79.3)",
                    "balanced: sinkage mm",
                    "balanced: current A"};
  return report;
}

}  // namespace

Result<Report> zhurong_states(const std::filesystem::path& data) {
  const auto table = CsvTable::read(
      data / "validation" / "zhurong_table_1.csv",
      {.numbers = {"k_c_kn", "k_phi_kn", "n", "cohesion_kpa", "friction_angle_deg", "shear_modulus_cm", "c1"},
       .numbers_or_empty = {"reproduced_torque_times_k_i", "reproduced_sinkage_mm"},
       .texts = {"state"}});
  if (!table) return fail(table.error());
  Report report = zhurong_states_report();
  std::vector<api::Chart> charts = empty_charts();
  double worst = 0.0;
  for (std::size_t k = 0; k < table->rows(); ++k) {
    const std::string& state = table->text(k, "state");
    const sim::Soil soil = soil_of(*table, k);
    const sim::ZhurongLiteral literal = sim::zhurong_literal(kWheel, soil, kLoad_n, 0.0);
    const double times_ki = literal.torque_nm * sim::kZhurongTorqueFactor;
    const double geared = sim::kZhurongTorqueFactor * sim::kZhurongImpliedGearRatio;
    const auto theta = sim::balanced_entry_angle_rad(kWheel, soil, kLoad_n, {1.0, 0.0});
    const double balanced =
        theta ? sim::wheel_forces(kWheel, soil, *theta, {1.0, 0.0}).torque_nm / geared : 0.0;
    if (!table->empty(k, "reproduced_torque_times_k_i")) {
      const double reproduced = table->number(k, "reproduced_torque_times_k_i");
      worst = std::max(worst, std::abs(times_ki / reproduced - 1.0));
      report.cases.push_back({state, "torque_times_k_i", "N^2 m^2/A", reproduced, times_ki});
      charts[0].series[0].x.push_back(reproduced);
      charts[0].series[0].y.push_back(times_ki);
    }
    if (!table->empty(k, "reproduced_sinkage_mm"))
      report.cases.push_back(
          {state, "sinkage_a18", "mm", table->number(k, "reproduced_sinkage_mm"), 1e3 * literal.sinkage_m});
    report.rows.push_back(
        {state, cell(*table, k, "reproduced_sinkage_mm", "{:.1f}"),
         fmt::format("{:.1f}", 1e3 * literal.sinkage_m),
         cell(*table, k, "reproduced_torque_times_k_i", "{:.3f}"), fmt::format("{:.3f}", times_ki),
         fmt::format("{:.4f}", literal.torque_nm / geared),
         theta ? fmt::format("{:.1f}", 1e3 * sim::sinkage_m(kWheel.radius_m, *theta)) : "sunk",
         fmt::format("{:.4f}", balanced)});
    charts[1].x.categories.push_back(state);
    for (api::ChartSeries& series : charts[1].series) series.x.push_back(static_cast<double>(k));
    charts[1].series[0].y.push_back(literal.torque_nm / geared);
    charts[1].series[1].y.push_back(theta ? balanced : std::nan(""));
  }
  report.notes.push_back(
      fmt::format("Largest difference of T k_I to the other reproduction: {:.1f} %.", 100.0 * worst));
  report.notes.push_back(
      "The paper prints 0.114 A for JLU Mars 2 dense and measured 0.110 A as the mean of six wheels; k_I "
      "without a gear would give 9.04 A, so a gear ratio of about 79 is missing from its text. The balanced "
      "wheel needs more torque because A18's entry angle carries only 227 N of the 334 N.");
  report.bands.push_back({"largest relative difference of T k_I", worst, 0.0, 0.01});
  report.plot = api::draw_charts(report.title, charts);
  return report;
}

}  // namespace slipway::validation
