#include <fmt/format.h>

#include <cmath>

#include "core/angle.h"
#include "sim/slip_table.h"
#include "tests/sim/reference_models.h"
#include "tests/validation/report.h"

namespace slipway::validation {

using namespace sim;

// The table rung against the quasi-static one, between the nodes where it is worst.
Report rungs() {
  Report report;
  report.title = "The table rung against the quasi-static rung";
  report.source =
      "this project's own quasi-static solver, at attitudes between the table's nodes (2.5 deg apart)";
  report.columns = {"soil", "slips compared",   "attitudes",   "largest difference of slip",
                    "rms",  "of side slip deg", "of current A"};
  const RoverModel rover = six_wheeler();
  struct Case {
    const char* name;
    Soil soil;
  };
  for (const Case& c : {Case{"sandy loam", sandy_loam()}, Case{"JLU Mars 3 loose", loose_sand()}}) {
    const SlipTable table(rover, 3.71, c.soil, rad_from_deg(30.0), rad_from_deg(2.5));
    for (const auto& [low, high] : {std::pair{-1.0, 0.4}, std::pair{0.4, 0.8}}) {
      QuasiStaticSolver solver(rover, 3.71);
      double slip = 0.0, slip2 = 0.0, side = 0.0, current = 0.0;
      int n = 0;
      for (double pitch = -24.0; pitch <= 24.0; pitch += 1.1)
        for (double roll = -18.0; roll <= 18.0; roll += 1.3) {
          const Attitude attitude{
              .roll_rad = rad_from_deg(roll), .pitch_rad = rad_from_deg(pitch), .yaw_rad = 0.0};
          const StationState exact =
              solver.solve(stance_on_plane(rover, attitude), c.soil, {.speed_m_s = rover.cruise_speed_m_s});
          if (!exact.moving() || exact.slip_ratio < low || exact.slip_ratio >= high) continue;
          const TableEntry entry = *table.at(attitude.pitch_rad, attitude.roll_rad);
          double largest = 0.0;
          for (const WheelState& w : exact.wheels) largest = std::max(largest, std::abs(w.current_a));
          slip = std::max(slip, std::abs(entry.slip_ratio - exact.slip_ratio));
          slip2 += std::pow(entry.slip_ratio - exact.slip_ratio, 2);
          side = std::max(side, std::abs(entry.side_slip_rad - exact.side_slip_rad));
          current = std::max(current, std::abs(entry.current_a - largest));
          ++n;
        }
      report.rows.push_back({c.name, fmt::format("{:.1f} to {:.1f}", low, high), fmt::format("{}", n),
                             fmt::format("{:.3f}", slip),
                             fmt::format("{:.4f}", std::sqrt(slip2 / std::max(1, n))),
                             fmt::format("{:.2f}", deg_from_rad(side)), fmt::format("{:.3f}", current)});
      if (high <= 0.4) report.holds = report.holds && slip < 0.03;
    }
  }
  report.notes.push_back(
      "Near the traction limit slip turns up faster than a straight line between nodes; the table serves the "
      "search, "
      "and every route is simulated by the quasi-static rung before it is ranked.");
  return report;
}

}  // namespace slipway::validation
