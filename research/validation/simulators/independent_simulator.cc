#include <fmt/format.h>

#include <array>
#include <cmath>

#include "api/files/catalogue.h"
#include "core/angle.h"
#include "research/validation/laboratory/laboratory_soil.h"
#include "research/validation/report/csv_table.h"
#include "research/validation/report/scatter_chart.h"
#include "research/validation/report/statistics.h"
#include "research/validation/simulators/comparisons.h"
#include "sim/quasi_static/quasi_static.h"

namespace slipway::validation {
namespace {

constexpr std::array kWheelNames{"lf", "lm", "lr", "rf", "rm", "rr"};
constexpr std::size_t kRearLeft = 2;

struct Series {
  std::vector<double> measured, predicted;
  double rms() const { return agreement(predicted, measured).rms; }
  void add(double m, double p) {
    measured.push_back(m);
    predicted.push_back(p);
  }
};

Result<CsvTable> read(const std::filesystem::path& data) {
  CsvTable::Columns columns;
  columns.texts = {"drive"};
  columns.numbers = {"pitch_deg", "roll_deg", "speed_m_s", "slip", "side_slip_deg"};
  for (const char* wheel : kWheelNames) {
    columns.numbers.push_back(fmt::format("{}_current_a", wheel));
    columns.numbers.push_back(fmt::format("{}_sinkage_m", wheel));
  }
  return CsvTable::read(data / "validation" / "practice_p01_drives.csv", columns);
}

// The report with its title, source and columns, without rows.
Report independent_simulator_report() {
  Report report;
  report.title = "The quasi-static rover against another rover simulator";
  report.source =
      "35 straight drives of the practice campaign p01 (tilts 0 to 18 deg; up, down, across; forward and "
      "backward) by a simulator that is not this project's, with sensor noise and soil that varies along the "
      "drives";
  report.columns = {"drive",     "pitch deg",           "roll deg", "slip", "predicted", "side slip deg",
                    "predicted", "rear left current A", "predicted"};
  return report;
}

}  // namespace

Result<Report> independent_simulator(const std::filesystem::path& data) {
  const auto drives = read(data);
  if (!drives) return fail(drives.error());
  const auto catalogue = api::load_catalogue(data);
  if (!catalogue) return fail(catalogue.error());
  const sim::RoverModel& rover = *catalogue->rovers.at("mer-class");  // the campaign's rover
  Report report = independent_simulator_report();
  Series slip, side, current, sinkage;
  double worst = 0.0;
  for (std::size_t row = 0; row < drives->rows(); ++row) {
    const auto number = [&](std::string_view column) { return drives->number(row, column); };
    sim::QuasiStaticSolver solver(rover, 3.71);
    const Attitude attitude{.roll_rad = rad_from_deg(number("roll_deg")),
                            .pitch_rad = rad_from_deg(number("pitch_deg")),
                            .yaw_rad = 0.0};
    const sim::StationState state = solver.solve(sim::stance_on_plane(rover, attitude), practice_soil(),
                                                 {.speed_m_s = number("speed_m_s")});
    const double backwards = number("speed_m_s") < 0.0 ? -1.0 : 1.0;
    slip.add(number("slip"), state.slip_ratio);
    side.add(number("side_slip_deg"), deg_from_rad(state.side_slip_rad));
    worst = std::max(worst, std::abs(slip.predicted.back() - slip.measured.back()));
    for (std::size_t k = 0; k < kWheelNames.size(); ++k) {
      current.add(number(fmt::format("{}_current_a", kWheelNames[k])), backwards * state.wheels[k].current_a);
      sinkage.add(1e3 * number(fmt::format("{}_sinkage_m", kWheelNames[k])), 1e3 * state.wheels[k].sinkage_m);
    }
    const std::string& drive = drives->text(row, "drive");
    report.cases.push_back({drive, "slip", "1", slip.measured.back(), slip.predicted.back()});
    report.cases.push_back({drive, "side_slip", "deg", side.measured.back(), side.predicted.back()});
    const std::size_t rear = 6 * row + kRearLeft;
    report.cases.push_back(
        {drive, "rear_left_current", "A", current.measured[rear], current.predicted[rear]});
    report.rows.push_back(
        {drive, fmt::format("{:.1f}", number("pitch_deg")), fmt::format("{:.1f}", number("roll_deg")),
         fmt::format("{:.3f}", slip.measured.back()), fmt::format("{:.3f}", slip.predicted.back()),
         fmt::format("{:.1f}", side.measured.back()), fmt::format("{:.1f}", side.predicted.back()),
         fmt::format("{:.3f}", current.measured[rear]), fmt::format("{:.3f}", current.predicted[rear])});
  }
  report.notes.push_back(fmt::format(
      "Root mean square difference: slip {:.4f} (largest {:.3f}), side slip {:.2f} deg, current of a wheel "
      "{:.4f} A, sinkage {:.2f} mm.",
      slip.rms(), worst, side.rms(), current.rms(), sinkage.rms()));
  report.notes.push_back(
      "The currents differ because the load is shared differently: here the drive torques act on "
      "the bogies, which shifts load from the middle to the rear wheels, while the other simulator "
      "loads both wheels of a bogie equally on level ground.");
  report.bands = {{"drives", static_cast<double>(drives->rows()), 35, 35},
                  {"rms of slip", slip.rms(), 0.0, 0.02},
                  {"rms of a wheel's current, A", current.rms(), 0.0, 0.04}};
  const api::Chart panels[] = {scatter_chart("slip", slip.measured, slip.predicted),
                               scatter_chart("side slip, deg", side.measured, side.predicted),
                               scatter_chart("current of a wheel, A", current.measured, current.predicted)};
  report.plot = api::draw_charts(report.title, panels);
  return report;
}

}  // namespace slipway::validation
