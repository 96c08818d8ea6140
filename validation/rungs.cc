#include <fmt/format.h>

#include <cmath>

#include "api/catalogue.h"
#include "api/chart.h"
#include "core/angle.h"
#include "sim/slip_table.h"
#include "validation/comparisons.h"
#include "validation/laboratory_soil.h"

namespace slipway::validation {
namespace {

constexpr double kGravity_m_s2 = 3.71;
constexpr double kFirstPitch_deg = -24.0, kPitchStep_deg = 1.1, kFirstRoll_deg = -18.0, kRollStep_deg = 1.3;
constexpr int kPitches = 44, kRolls = 28;

// Both rungs at one attitude between the table's nodes.
struct Attempt {
  sim::StationState exact;
  sim::TableEntry entry;
  double largest_current_a = 0.0;
};

std::vector<Attempt> attempts_on(const sim::RoverModel& rover, const sim::Soil& soil) {
  const sim::SlipTable table(rover, kGravity_m_s2, soil, rad_from_deg(30.0), rad_from_deg(2.5));
  sim::QuasiStaticSolver solver(rover, kGravity_m_s2);
  std::vector<Attempt> attempts;
  for (int p = 0; p < kPitches; ++p)
    for (int r = 0; r < kRolls; ++r) {
      const Attitude attitude{.roll_rad = rad_from_deg(kFirstRoll_deg + kRollStep_deg * r),
                              .pitch_rad = rad_from_deg(kFirstPitch_deg + kPitchStep_deg * p),
                              .yaw_rad = 0.0};
      Attempt attempt;
      attempt.exact =
          solver.solve(sim::stance_on_plane(rover, attitude), soil, {.speed_m_s = rover.cruise_speed_m_s});
      attempt.entry = *table.at(attitude.pitch_rad, attitude.roll_rad);
      for (const sim::WheelState& w : attempt.exact.wheels)
        attempt.largest_current_a = std::max(attempt.largest_current_a, std::abs(w.current_a));
      attempts.push_back(attempt);
    }
  return attempts;
}

void compare(const char* soil, const std::vector<Attempt>& attempts, double low, double high,
             Report& report) {
  double slip = 0.0, slip2 = 0.0, side = 0.0, current = 0.0;
  int n = 0;
  for (const Attempt& a : attempts) {
    if (!a.exact.moving() || a.exact.slip_ratio < low || a.exact.slip_ratio >= high) continue;
    const double error = a.entry.slip_ratio - a.exact.slip_ratio;
    slip = std::max(slip, std::abs(error));
    slip2 += error * error;
    side = std::max(side, std::abs(a.entry.side_slip_rad - a.exact.side_slip_rad));
    current = std::max(current, std::abs(a.entry.current_a - a.largest_current_a));
    ++n;
  }
  report.rows.push_back({soil, fmt::format("{:.1f} to {:.1f}", low, high), fmt::format("{}", n),
                         fmt::format("{:.3f}", slip),
                         fmt::format("{:.4f}", std::sqrt(slip2 / std::max(1, n))),
                         fmt::format("{:.2f}", deg_from_rad(side)), fmt::format("{:.3f}", current)});
  if (high <= 0.4)
    report.bands.push_back(
        {fmt::format("largest difference of slip below 0.4 on {}", soil), slip, 0.0, 0.03});
}

std::vector<double> edges(double first, double step, int cells) {
  std::vector<double> e;
  for (int k = 0; k <= cells; ++k) e.push_back(first + step * (k - 0.5));
  return e;
}

std::string error_map(const std::vector<Attempt>& attempts) {
  api::HeatMap map;
  map.title = "JLU Mars 3 loose: how far the table's slip is from the balance";
  map.x.title = "pitch, deg (positive nose down)";
  map.y.title = "roll, deg";
  map.x_edges = edges(kFirstPitch_deg, kPitchStep_deg, kPitches);
  map.y_edges = edges(kFirstRoll_deg, kRollStep_deg, kRolls);
  map.value_title = "difference of slip (grey: immobile)";
  for (int r = 0; r < kRolls; ++r)
    for (int p = 0; p < kPitches; ++p) {
      const Attempt& a = attempts[static_cast<std::size_t>(p * kRolls + r)];
      map.values.push_back(a.exact.moving() ? std::optional(std::abs(a.entry.slip_ratio - a.exact.slip_ratio))
                                            : std::nullopt);
    }
  return api::draw_heat_map(map);
}

}  // namespace

// The table rung against the quasi-static one, between the nodes where it is worst.
Result<Report> rungs(const std::filesystem::path& data) {
  const auto catalogue = api::load_catalogue(data);
  if (!catalogue) return fail(catalogue.error());
  const sim::RoverModel& rover = *catalogue->rovers.at("mer-class");
  Report report;
  report.title = "The table rung against the quasi-static rung";
  report.source =
      "this project's own quasi-static solver, at attitudes between the table's nodes (2.5 deg apart)";
  report.columns = {"soil", "slips compared",   "attitudes",   "largest difference of slip",
                    "rms",  "of side slip deg", "of current A"};
  struct Ground {
    const char* name;
    sim::Soil soil;
  };
  for (const Ground& ground :
       {Ground{"sandy loam", practice_soil()}, Ground{"JLU Mars 3 loose", jlu_mars_3_loose()}}) {
    const std::vector<Attempt> attempts = attempts_on(rover, ground.soil);
    compare(ground.name, attempts, -1.0, 0.4, report);
    compare(ground.name, attempts, 0.4, 0.8, report);
    report.plot = error_map(attempts);
  }
  report.notes.push_back(
      "Near the traction limit slip turns up faster than a straight line between nodes; the table serves the "
      "search, and every route is simulated by the quasi-static rung before it is ranked.");
  return report;
}

}  // namespace slipway::validation
