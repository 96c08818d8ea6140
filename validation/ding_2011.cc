#include <fmt/format.h>

#include "api/chart.h"
#include "sim/entry_angle.h"
#include "sim/slip_ratio.h"
#include "validation/comparisons.h"
#include "validation/csv_table.h"
#include "validation/laboratory_soil.h"
#include "validation/statistics.h"

namespace slipway::validation {
namespace {

constexpr double kLoad_n = 80.0;
constexpr sim::WheelGeometry kWheel{.radius_m = 0.15735, .width_m = 0.165};

struct Wheel {
  double pull_n, sinkage_mm, torque_nm;
};

Wheel predict(double slip) {
  static const sim::Soil soil = laboratory_soil({15'600.0, 2'407'400.0, 1.1}, 250.0, 31.9, 0.011, 0.18, 0.32);
  const sim::WheelMotion motion{sim::speed_ratio_from_slip(slip), 0.0};
  const double theta = sim::balanced_entry_angle_rad(kWheel, soil, kLoad_n, motion).value();
  const sim::WheelForces f = sim::wheel_forces(kWheel, soil, theta, motion);
  return {f.drawbar_pull_n, 1e3 * sim::sinkage_m(kWheel.radius_m, theta), f.torque_nm};
}

struct Errors {
  std::vector<double> pull, sinkage, torque;
};

std::string percent(double predicted, double measured, std::vector<double>& errors) {
  if (measured == 0.0) return "-";
  errors.push_back(predicted / measured - 1.0);
  return fmt::format("{:+.0f} %", 100.0 * errors.back());
}

void compare(const CsvTable& table, const std::string& wheel, Report& report) {
  Errors errors;
  for (std::size_t k = 0; k < table.rows(); ++k) {
    if (table.text(k, "wheel") != wheel) continue;
    const double slip = table.number(k, "slip");
    const Wheel measured{table.number(k, "drawbar_pull_n"), table.number(k, "sinkage_mm"),
                         table.number(k, "torque_nm")};
    const Wheel ours = predict(slip);
    report.rows.push_back({wheel, fmt::format("{:.1f}", slip), fmt::format("{:g}", measured.pull_n),
                           fmt::format("{:.1f}", ours.pull_n),
                           percent(ours.pull_n, measured.pull_n, errors.pull),
                           fmt::format("{:g}", measured.sinkage_mm), fmt::format("{:.1f}", ours.sinkage_mm),
                           percent(ours.sinkage_mm, measured.sinkage_mm, errors.sinkage),
                           fmt::format("{:g}", measured.torque_nm), fmt::format("{:.2f}", ours.torque_nm),
                           percent(ours.torque_nm, measured.torque_nm, errors.torque)});
    const std::string name = fmt::format("{}, slip {:.1f}", wheel, slip);
    report.cases.push_back({name, "drawbar_pull", "N", measured.pull_n, ours.pull_n});
    report.cases.push_back({name, "sinkage", "mm", measured.sinkage_mm, ours.sinkage_mm});
    report.cases.push_back({name, "torque", "N m", measured.torque_nm, ours.torque_nm});
  }
  report.notes.push_back(fmt::format("{}: median error of pull {:.0f} %, sinkage {:.0f} %, torque {:.0f} %.",
                                     wheel, 100.0 * median_abs(errors.pull),
                                     100.0 * median_abs(errors.sinkage), 100.0 * median_abs(errors.torque)));
}

api::Chart panel(const CsvTable& table, const char* title, const char* column, double Wheel::*ours) {
  api::Chart chart;
  chart.title = title;
  chart.x.title = "slip";
  chart.y.title = title;
  api::ChartSeries line{"ours, plain wheel", api::ChartMark::kLine, {}, {}, 0};
  for (int k = 0; k <= 30; ++k) {
    line.x.push_back(0.02 * k);
    line.y.push_back(predict(0.02 * k).*ours);
  }
  chart.series = {{"measured, smooth", api::ChartMark::kPoints, {}, {}, 0},
                  {"measured, lugged", api::ChartMark::kPoints, {}, {}, 1},
                  line};
  for (std::size_t k = 0; k < table.rows(); ++k) {
    api::ChartSeries& series = chart.series[table.text(k, "wheel") == "smooth" ? 0 : 1];
    series.x.push_back(table.number(k, "slip"));
    series.y.push_back(table.number(k, column));
  }
  return chart;
}

}  // namespace

Result<Report> ding_2011(const std::filesystem::path& data) {
  const auto table = CsvTable::read(data / "validation" / "ding_2011.csv",
                                    {.numbers = {"slip", "drawbar_pull_n", "sinkage_mm", "torque_nm"},
                                     .numbers_or_empty = {},
                                     .texts = {"wheel"}});
  if (!table) return fail(table.error());
  Report report;
  report.title = "Single-wheel tests of Ding et al. 2011, with nothing fitted";
  report.source =
      "Ding et al. 2011, smooth and lugged wheel, r 157.35 mm, b 165 mm, 80 N, digitised by the authors of "
      "RoverDevKit; soil n 1.1, k_c 15.6, k_phi 2407.4, c 0.25 kPa, phi 31.9 deg, K 11 mm";
  report.peers =
      "open ones on the same rows, median errors: the plain wheel pull 35 to 40 %, sinkage 42 to 85 %, "
      "torque "
      "4 to 14 %; RoverDevKit pull 27 %";
  report.columns = {"wheel", "slip",  "pull N",     "ours", "error", "sinkage mm",
                    "ours",  "error", "torque N m", "ours", "error"};
  compare(*table, "smooth", report);
  compare(*table, "lugged", report);
  report.notes.push_back(
      "Not in the model of this table: slip sinkage (the measured wheel digs from 5 to 17 mm and more as it "
      "slips, the bare wheel hardly at all), grousers, and a rear exit angle. c1 and c2 are Wong and Reece's "
      "for loose sand. Digitised figures carry a reading error of about 5 %.");
  const api::Chart panels[] = {panel(*table, "drawbar pull, N", "drawbar_pull_n", &Wheel::pull_n),
                               panel(*table, "sinkage, mm", "sinkage_mm", &Wheel::sinkage_mm),
                               panel(*table, "torque, N m", "torque_nm", &Wheel::torque_nm)};
  report.plot = api::draw_charts(report.title, panels);
  return report;
}

}  // namespace slipway::validation
