#include <fmt/format.h>

#include <algorithm>

#include "api/chart/chart.h"
#include "research/validation/laboratory/laboratory_soil.h"
#include "research/validation/report/csv_table.h"
#include "research/validation/simulators/comparisons.h"
#include "sim/wheel/entry_angle.h"
#include "sim/wheel/slip_ratio.h"

namespace slipway::validation {
namespace {

constexpr double kShearModulus_m = 0.018;
constexpr double kLoad_n = 50.0;
constexpr sim::WheelGeometry kWheel{.radius_m = 0.1, .width_m = 0.06};

struct Range {
  double low, high;
  bool holds(double value) const { return value >= low && value <= high; }
  std::string words(const char* format) const { return fmt::format(fmt::runtime(format), low, high); }
};

struct BandRow {
  double slip;
  Range sinkage_mm, pull_n, torque_nm;
};

struct Prediction {
  double sinkage_mm, pull_n, torque_nm;
};

Prediction predict(double shear_modulus_m, double slip) {
  const sim::Soil soil = laboratory_soil({1400.0, 820'000.0, 1.0}, 1000.0, 45.0, shear_modulus_m, 0.4, 0.2);
  const sim::WheelMotion motion{sim::speed_ratio_from_slip(slip), 0.0};
  const double theta = sim::balanced_entry_angle_rad(kWheel, soil, kLoad_n, motion).value();
  const sim::WheelForces f = sim::wheel_forces(kWheel, soil, theta, motion);
  return {1e3 * sim::sinkage_m(kWheel.radius_m, theta), f.drawbar_pull_n, f.torque_nm};
}

bool holds(const BandRow& row, const Prediction& ours) {
  return row.sinkage_mm.holds(ours.sinkage_mm) && row.pull_n.holds(ours.pull_n) &&
         row.torque_nm.holds(ours.torque_nm);
}

bool all_hold(const std::vector<BandRow>& rows, double shear_modulus_m) {
  return std::all_of(rows.begin(), rows.end(),
                     [&](const BandRow& row) { return holds(row, predict(shear_modulus_m, row.slip)); });
}

api::Chart panel(const char* quantity, const std::vector<BandRow>& rows, Range BandRow::*band,
                 double Prediction::*ours) {
  api::Chart chart;
  chart.title = quantity;
  chart.x.title = "slip";
  chart.y.title = quantity;
  chart.bands.push_back({"published band", {}, {}, {}, 1});
  for (const BandRow& row : rows) {
    chart.bands[0].x.push_back(row.slip);
    chart.bands[0].lower.push_back((row.*band).low);
    chart.bands[0].upper.push_back((row.*band).high);
  }
  chart.series.push_back({"ours, K = 18 mm", api::ChartMark::kLine, {}, {}, 0});
  for (int k = 0; k <= 30; ++k) {
    chart.series[0].x.push_back(0.02 * k);
    chart.series[0].y.push_back(predict(kShearModulus_m, 0.02 * k).*ours);
  }
  return chart;
}

}  // namespace

Result<Report> kernel_cross_check(const std::filesystem::path& data) {
  const auto table = CsvTable::read(data / "validation" / "roverdevkit_bands.csv",
                                    {.numbers = {"slip", "sinkage_low_mm", "sinkage_high_mm", "pull_low_n",
                                                 "pull_high_n", "torque_low_nm", "torque_high_nm"},
                                     .numbers_or_empty = {},
                                     .texts = {}});
  if (!table) return fail(table.error());
  std::vector<BandRow> rows;
  for (std::size_t k = 0; k < table->rows(); ++k)
    rows.push_back({table->number(k, "slip"),
                    {table->number(k, "sinkage_low_mm"), table->number(k, "sinkage_high_mm")},
                    {table->number(k, "pull_low_n"), table->number(k, "pull_high_n")},
                    {table->number(k, "torque_low_nm"), table->number(k, "torque_high_nm")}});
  Report report;
  report.title = "The wheel kernel against another implementation of the same equations";
  report.source =
      "RoverDevKit regression rows (arXiv 2606.21755): r 0.1 m, b 0.06 m, 50 N, n 1, k_c 1.4, k_phi 820, "
      "c 1 kPa, phi 45 deg, c1 0.4, c2 0.2";
  report.columns = {"slip",      "sinkage mm, band", "predicted", "pull N, band",
                    "predicted", "torque N m, band", "predicted", "inside"};
  for (const BandRow& row : rows) {
    const Prediction ours = predict(kShearModulus_m, row.slip);
    report.rows.push_back({fmt::format("{:.2f}", row.slip), row.sinkage_mm.words("{:.0f} to {:.0f}"),
                           fmt::format("{:.1f}", ours.sinkage_mm), row.pull_n.words("{:.1f} to {:.1f}"),
                           fmt::format("{:.2f}", ours.pull_n), row.torque_nm.words("{:.2f} to {:.2f}"),
                           fmt::format("{:.3f}", ours.torque_nm), holds(row, ours) ? "yes" : "NO"});
    const auto band = [&](const char* quantity, double value, const Range& range) {
      report.bands.push_back(
          {fmt::format("{} at slip {:.2f}", quantity, row.slip), value, range.low, range.high});
    };
    band("sinkage, mm,", ours.sinkage_mm, row.sinkage_mm);
    band("pull, N,", ours.pull_n, row.pull_n);
    band("torque, N m,", ours.torque_nm, row.torque_nm);
  }
  double low = 1.0, high = 0.0;
  for (int tenth_mm = 50; tenth_mm <= 400; ++tenth_mm)
    if (all_hold(rows, 1e-4 * tenth_mm)) {
      low = std::min(low, 1e-4 * tenth_mm);
      high = std::max(high, 1e-4 * tenth_mm);
    }
  report.notes.push_back(fmt::format(
      "The rows do not give the shear modulus. All nine bands hold for K from {:.1f} to {:.1f} mm; "
      "the table is for K = {:.0f} mm. One unstated number explains nine bands, which is "
      "evidence for the equations but not for K.",
      1e3 * low, 1e3 * high, 1e3 * kShearModulus_m));
  api::Chart panels[] = {panel("sinkage, mm", rows, &BandRow::sinkage_mm, &Prediction::sinkage_mm),
                         panel("drawbar pull, N", rows, &BandRow::pull_n, &Prediction::pull_n),
                         panel("torque, N m", rows, &BandRow::torque_nm, &Prediction::torque_nm)};
  panels[0].y.lowest = 24.0;  // room beside the band
  panels[0].y.highest = 31.0;
  report.plot = api::draw_charts(report.title, panels);
  return report;
}

}  // namespace slipway::validation
