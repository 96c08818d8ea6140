#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "core/angle.h"
#include "sim/quasi_static.h"
#include "tests/sim/reference_models.h"
#include "tests/validation/report.h"

namespace slipway::validation {
namespace {

using namespace sim;

struct Drive {
  std::string id;
  std::array<double, 17> column;  // pitch roll speed slip side_slip, six currents, six sinkages
};

std::vector<Drive> read(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot open " + path);
  std::vector<Drive> drives;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    Drive drive;
    std::getline(cells, drive.id, ',');
    std::string cell;
    for (double& value : drive.column) {
      std::getline(cells, cell, ',');
      value = std::stod(cell);
    }
    drives.push_back(drive);
  }
  return drives;
}

StationState predict(const Drive& drive) {
  const RoverModel rover = six_wheeler();  // the campaign's rover
  QuasiStaticSolver solver(rover, 3.71);
  const Attitude attitude{
      .roll_rad = rad_from_deg(drive.column[1]), .pitch_rad = rad_from_deg(drive.column[0]), .yaw_rad = 0.0};
  return solver.solve(stance_on_plane(rover, attitude), sandy_loam(), {.speed_m_s = drive.column[2]});
}

}  // namespace

Report independent_simulator(const std::string& csv_path) {
  Report report;
  report.title = "The quasi-static rover against another rover simulator";
  report.source =
      "35 straight drives of the practice campaign p01 (tilts 0 to 18 deg; up, down, across; forward and "
      "backward) by a simulator that is not this project's, with sensor noise and soil that varies along the "
      "drives";
  report.columns = {"drive", "pitch deg",           "roll deg", "slip", "ours", "side slip deg",
                    "ours",  "rear left current A", "ours"};
  double slip2 = 0.0, side2 = 0.0, current2 = 0.0, sinkage2 = 0.0, worst = 0.0;
  const std::vector<Drive> drives = read(csv_path);
  for (const Drive& drive : drives) {
    const StationState state = predict(drive);
    const double slip = state.slip_ratio - drive.column[3];
    const double backwards = drive.column[2] < 0.0 ? -1.0 : 1.0;
    const double side = deg_from_rad(state.side_slip_rad) - drive.column[4];
    slip2 += slip * slip;
    side2 += side * side;
    worst = std::max(worst, std::abs(slip));
    const int wheels = static_cast<int>(state.wheels.size());
    for (int k = 0; k < wheels; ++k) {
      current2 += std::pow(backwards * state.wheels[k].current_a - drive.column[5 + k], 2) / wheels;
      sinkage2 += std::pow(1e3 * (state.wheels[k].sinkage_m - drive.column[11 + k]), 2) / wheels;
    }
    report.rows.push_back({drive.id, fmt::format("{:.1f}", drive.column[0]),
                           fmt::format("{:.1f}", drive.column[1]), fmt::format("{:.3f}", drive.column[3]),
                           fmt::format("{:.3f}", state.slip_ratio), fmt::format("{:.1f}", drive.column[4]),
                           fmt::format("{:.1f}", deg_from_rad(state.side_slip_rad)),
                           fmt::format("{:.3f}", drive.column[7]),
                           fmt::format("{:.3f}", backwards * state.wheels[2].current_a)});
  }
  const double n = static_cast<double>(drives.size());
  const double slip_rms = std::sqrt(slip2 / n), current_rms = std::sqrt(current2 / n);
  report.notes.push_back(fmt::format(
      "Root mean square difference: slip {:.4f} (largest {:.3f}), side slip {:.2f} deg, current of a wheel "
      "{:.4f} A, sinkage {:.2f} mm.",
      slip_rms, worst, std::sqrt(side2 / n), current_rms, std::sqrt(sinkage2 / n)));
  report.notes.push_back(
      "The currents part where the load is shared: here the drive torques act on the bogies, which shifts "
      "load from "
      "the middle to the rear wheels; the other simulator loads both wheels of a bogie alike on level "
      "ground.");
  report.holds = n == 35 && slip_rms < 0.02 && current_rms < 0.04;
  return report;
}

}  // namespace slipway::validation
