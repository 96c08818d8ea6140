#include <fmt/format.h>

#include <cmath>

#include "api/chart/chart.h"
#include "api/files/catalogue.h"
#include "core/angle.h"
#include "research/validation/laboratory/laboratory_soil.h"
#include "research/validation/simulators/comparisons.h"
#include "sim/prediction/drive_risk.h"
#include "sim/quasi_static/slip_table.h"

namespace slipway::validation {
namespace {

constexpr double kFirstPitch_deg = -24.0, kPitchStep_deg = 1.1, kFirstRoll_deg = -18.0, kRollStep_deg = 1.3;
// Currents have a kink where the ground begins to drive a motor, which the table rounds off.
constexpr double kCurrentBand = 0.003, kEnergyBand = 0.03;
constexpr int kPitches = 44, kRolls = 28;
const double kTableLimit_rad = rad_from_deg(30.0), kTableStep_rad = rad_from_deg(2.5);

// Both levels at one attitude between the table's nodes.
struct Attempt {
  sim::StationState exact;
  sim::TableEntry entry;
  double pitch_rad = 0.0;  // of the plane
  double energy_j_m = 0.0;

  // Whether the table covers the attitude: the rover is not stuck and does not slide down across its heading
  // faster than it drives along it.
  bool gets_ahead() const {
    return exact.moving() && std::abs(exact.leftward_m_s) < exact.forward_m_s && !entry.immobile;
  }
};

std::vector<Attempt> attempts_on(const sim::RoverModel& rover, double gravity_m_s2, const sim::Soil& soil) {
  const sim::SlipTable table(rover, gravity_m_s2, soil, kTableLimit_rad, kTableStep_rad);
  sim::QuasiStaticSolver solver(rover, gravity_m_s2);
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
      attempt.pitch_rad = attitude.pitch_rad;
      attempt.energy_j_m =
          attempt.exact.electric_power_w / (attempt.exact.forward_m_s * std::cos(attitude.pitch_rad));
      attempts.push_back(attempt);
    }
  return attempts;
}

// The maximum differences of the table. Sinkage is relative to its value. Current and energy pass through 0
// downhill; where they are less than a tenth of their maximum, they are relative to that maximum.
struct Differences {
  int attitudes = 0;
  double slip = 0.0, slip_rms = 0.0, side_slip_deg = 0.0, sinkage = 0.0, current = 0.0, energy = 0.0;
  double pitch_deg = 0.0;
};

Differences differences(const std::vector<Attempt>& attempts, double low, double high) {
  double largest_current = 0.0, largest_energy = 0.0;
  for (const Attempt& a : attempts) {
    if (!a.gets_ahead() || a.exact.slip_ratio >= 0.8) continue;
    largest_current = std::max(largest_current, sim::largest_current_a(a.exact));
    largest_energy = std::max(largest_energy, a.energy_j_m);
  }
  const auto relative = [](double of, double to, double largest) {
    return std::abs(of - to) / (to < 0.1 * largest ? largest : to);
  };
  Differences d;
  for (const Attempt& a : attempts) {
    if (!a.gets_ahead() || a.exact.slip_ratio < low || a.exact.slip_ratio >= high) continue;
    const double slip = a.entry.slip_ratio - a.exact.slip_ratio;
    ++d.attitudes;
    d.slip = std::max(d.slip, std::abs(slip));
    d.slip_rms += slip * slip;
    d.side_slip_deg =
        std::max(d.side_slip_deg, deg_from_rad(std::abs(a.entry.side_slip_rad - a.exact.side_slip_rad)));
    const double pitch_rad = a.pitch_rad + a.entry.pitch_lean_rad;
    d.pitch_deg = std::max(d.pitch_deg, deg_from_rad(std::abs(pitch_rad - a.exact.attitude.pitch_rad)));
    d.sinkage = std::max(d.sinkage, relative(a.entry.sinkage_m, sim::deepest_sinkage_m(a.exact), 0.0));
    d.current =
        std::max(d.current, relative(a.entry.current_a, sim::largest_current_a(a.exact), largest_current));
    d.energy = std::max(d.energy, relative(a.entry.energy_j_m, a.energy_j_m, largest_energy));
  }
  d.slip_rms = std::sqrt(d.slip_rms / std::max(1, d.attitudes));
  return d;
}

void compare(const std::string& name, const std::vector<Attempt>& attempts, double low, double high,
             Report& report) {
  const Differences d = differences(attempts, low, high);
  const std::string slips = fmt::format("{:.1f} to {:.1f}", low, high);
  const auto percent = [](double share) { return fmt::format("{:.2f}", 100.0 * share); };
  report.rows.push_back({name, slips, fmt::format("{}", d.attitudes), fmt::format("{:.4f}", d.slip),
                         fmt::format("{:.5f}", d.slip_rms), fmt::format("{:.2f}", d.side_slip_deg),
                         fmt::format("{:.3f}", d.pitch_deg), percent(d.sinkage), percent(d.current),
                         percent(d.energy)});
  const auto band = [&](const char* what, double value, double highest) {
    report.bands.push_back({fmt::format("{}, {}, slip {}", what, name, slips), value, 0.0, highest});
  };
  band("largest difference of slip", d.slip, 0.01);
  band("largest difference of side slip, deg", d.side_slip_deg, 1.0);
  band("largest difference of the body's pitch, deg", d.pitch_deg, 0.05);
  band("largest difference of sinkage, share", d.sinkage, 0.01);
  band("largest difference of current, share", d.current, kCurrentBand);
  band("largest difference of energy per metre, share", d.energy, kEnergyBand);
}

// Counts the attitudes at which the two disagree on whether the rover makes headway.
void compare_limits(const std::string& name, const std::vector<Attempt>& attempts, Report& report) {
  int wrong = 0;
  for (const Attempt& a : attempts) {
    const bool ahead = a.exact.moving() && std::abs(a.exact.leftward_m_s) < a.exact.forward_m_s;
    if (ahead == a.entry.immobile) ++wrong;
  }
  report.bands.push_back({fmt::format("attitudes that only one of them can climb, share, {}", name),
                          static_cast<double>(wrong) / static_cast<double>(attempts.size()), 0.0, 0.01});
}

std::vector<double> edges(double first, double step, int cells) {
  std::vector<double> e;
  for (int k = 0; k <= cells; ++k) e.push_back(first + step * (k - 0.5));
  return e;
}

std::string error_map(const std::vector<Attempt>& attempts) {
  api::HeatMap map;
  map.title = "JLU Mars 3 loose: how far the table's slip is from the balance (mer-class)";
  map.x.title = "pitch, deg (positive nose down)";
  map.y.title = "roll, deg";
  map.x_edges = edges(kFirstPitch_deg, kPitchStep_deg, kPitches);
  map.y_edges = edges(kFirstRoll_deg, kRollStep_deg, kRolls);
  map.value_title = "difference of slip (grey: immobile)";
  for (int r = 0; r < kRolls; ++r)
    for (int p = 0; p < kPitches; ++p) {
      const Attempt& a = attempts[static_cast<std::size_t>(p) * kRolls + static_cast<std::size_t>(r)];
      map.values.push_back(a.gets_ahead() ? std::optional(std::abs(a.entry.slip_ratio - a.exact.slip_ratio))
                                          : std::nullopt);
    }
  return api::draw_heat_map(map);
}

}  // namespace

// Compares the table level with the quasi-static one between the nodes, where the table is worst.
Result<Report> table_level(const std::filesystem::path& data) {
  const auto catalogue = api::load_catalogue(data);
  if (!catalogue) return fail(catalogue.error());
  Report report;
  report.title = "The table level against the quasi-static level";
  report.source =
      "this project's own quasi-static solver, at attitudes between the table's nodes (2.5 deg apart in "
      "roll)";
  report.columns = {"rover on soil", "slips compared",   "attitudes",    "largest difference of slip",
                    "rms",           "of side slip deg", "of pitch deg", "of sinkage %",
                    "of current %",  "of energy %"};
  struct Vehicle {
    const char* name;
    double gravity_m_s2;
  };
  struct Ground {
    const char* name;
    sim::Soil soil;
  };
  const auto soil = [&](const char* name) { return catalogue->soils.at(name).mean; };
  for (const Vehicle& vehicle : {Vehicle{"mer-class", 3.71}, Vehicle{"cuadriga", 9.81}}) {
    const sim::RoverModel& rover = *catalogue->rovers.at(vehicle.name);
    for (const Ground& ground :
         {Ground{"sandy loam", practice_soil()}, Ground{"JLU Mars 2 medium", soil("jlu_mars_2_medium")},
          Ground{"JLU Mars 2 loose", soil("jlu_mars_2_loose")}, Ground{"Ding 2011", soil("ding_2011")},
          Ground{"JLU Mars 3 loose", jlu_mars_3_loose()}}) {
      const std::vector<Attempt> attempts = attempts_on(rover, vehicle.gravity_m_s2, ground.soil);
      const std::string name = fmt::format("{} on {}", vehicle.name, ground.name);
      compare(name, attempts, -1.0, 0.4, report);
      compare(name, attempts, 0.4, 0.8, report);
      compare_limits(name, attempts, report);
      if (vehicle.gravity_m_s2 < 9.0) report.plot = error_map(attempts);
    }
  }
  report.notes.push_back(
      "The table ends where the rover makes no more headway: where it slides down across its "
      "heading faster than it drives along it, or its wheels spin. Beyond, the table says "
      "immobile, while the quasi-static level often still finds a motion there, mostly sideways.");
  return report;
}

}  // namespace slipway::validation
