#include <fmt/format.h>

#include <cmath>

#include "api/files/catalogue.h"
#include "core/angle.h"
#include "core/random.h"
#include "dem/elevation_source.h"
#include "planner/judge/verify_route.h"
#include "planner/make_plan.h"
#include "planner/predict_path.h"
#include "planner/problem/motion.h"
#include "research/validation/laboratory/laboratory_soil.h"
#include "research/validation/report/scatter_chart.h"
#include "research/validation/simulators/comparisons.h"

namespace slipway::validation {
namespace {

constexpr int kRoutes = 10;
constexpr double kLength_m = 25.0;
constexpr double kSteepest_rad = rad_from_deg(16.0);
constexpr std::uint64_t kSeed = 2026;

struct Straight {
  Pose2 from;
  double to_x_m = 0.0, to_y_m = 0.0;
};

// Straight lines anywhere on the terrain in any direction, where the ground is known and no steeper than the
// limit.
std::vector<Straight> straights_on(const dem::Terrain& terrain) {
  std::vector<Straight> routes;
  const dem::Extent grid = terrain.geometry().extent();
  for (std::uint64_t n = 0; routes.size() < kRoutes; ++n) {
    const auto draw = [&](std::uint64_t i) { return random_uniform(random_key(kSeed, n), i); };
    Straight route;
    route.from.x_m = grid.west_m + draw(0) * (grid.east_m - grid.west_m);
    route.from.y_m = grid.south_m + draw(1) * (grid.north_m - grid.south_m);
    route.from.yaw_rad = 2.0 * M_PI * draw(2);
    const double c = std::cos(route.from.yaw_rad), s = std::sin(route.from.yaw_rad);
    route.to_x_m = route.from.x_m + kLength_m * c;
    route.to_y_m = route.from.y_m + kLength_m * s;
    bool drivable = true;
    for (double along = -2.0; along <= kLength_m + 2.0 && drivable; along += 0.5)
      for (const double across : {-1.5, 0.0, 1.5}) {
        const auto point =
            terrain.surface(route.from.x_m + along * c - across * s, route.from.y_m + along * s + across * c);
        drivable = drivable && point && point->slope_rad() < kSteepest_rad;
      }
    if (drivable) routes.push_back(route);
  }
  return routes;
}

void add_row(const Straight& route, const sim::DrivePrediction& balance,
             const planner::DynamicVerification& dynamics, Report& report) {
  const auto signed_mm = [](double m) { return fmt::format("{:+.2f}", 1e3 * m); };
  report.rows.push_back({fmt::format("({:.0f}, {:.0f}) to ({:.0f}, {:.0f})", route.from.x_m, route.from.y_m,
                                     route.to_x_m, route.to_y_m),
                         std::string(planner::end_in_words(dynamics)),
                         fmt::format("{:.1f}", deg_from_rad(balance.max_tilt_rad.value)),
                         fmt::format("{:.3f}", balance.mean_slip_ratio),
                         fmt::format("{:+.4f}", dynamics.slip_ratio.mean),
                         fmt::format("{:.4f}", dynamics.slip_ratio.mean_abs),
                         fmt::format("{:.3f} at {:.0f} m", dynamics.slip_ratio.largest.value,
                                     dynamics.slip_ratio.largest.distance_m),
                         signed_mm(dynamics.sinkage_m.mean), signed_mm(dynamics.sinkage_m.largest.value),
                         fmt::format("{:+.3f}", dynamics.current_a.mean),
                         fmt::format("{:.3f}", dynamics.current_a.largest.value)});
}

}  // namespace

// Compares the dynamic level with the quasi-static one along straight drives on real terrain.
Result<Report> dynamic_level(const std::filesystem::path& data) {
  const auto catalogue = api::load_catalogue(data);
  if (!catalogue) return fail(catalogue.error());
  const auto source = dem::open_elevation((data / "terrains/gale/elevation.tif").string());
  if (!source) return fail(source.error());
  const auto terrain = (*source)->read((*source)->info().geometry.extent());
  if (!terrain) return fail(terrain.error());
  Report report;
  report.title = "The dynamic level against the quasi-static level";
  report.source =
      "this project's own quasi-static solver, along ten straight drives of 25 m on the Marias Pass DEM";
  report.columns = {"route",
                    "end",
                    "steepest tilt deg",
                    "mean slip, quasi-static",
                    "dynamic less quasi-static",
                    "mean, unsigned",
                    "largest",
                    "sinkage mm",
                    "largest",
                    "current A",
                    "largest"};
  planner::PlanProblem problem;
  problem.terrain = *terrain;
  problem.rover = catalogue->rovers.at("mer-class");
  problem.beliefs.unknown.name = "sandy loam";
  problem.beliefs.unknown.mean = practice_soil();
  problem.risk.draws = 0;
  NoProgress progress;
  double slip = 0.0, sinkage = 0.0, current = 0.0;
  for (const Straight& route : straights_on(**terrain)) {
    const std::vector<planner::Waypoint> corners{{route.from.x_m, route.from.y_m, route.from.yaw_rad},
                                                 {route.to_x_m, route.to_y_m, std::nullopt}};
    const auto balance = planner::predict_path(problem, corners, progress);
    if (!balance) return fail(balance.error());
    const auto dynamics = planner::verify_route(
        problem, {planner::straight(route.from, route.to_x_m, route.to_y_m)}, {}, *balance, progress);
    if (!dynamics) return fail(dynamics.error());
    add_row(route, *balance, *dynamics, report);
    slip += dynamics->slip_ratio.mean_abs / kRoutes;
    sinkage += dynamics->sinkage_m.mean_abs / kRoutes;
    current += dynamics->current_a.mean_abs / kRoutes;
  }
  report.bands.push_back({"mean difference of slip, unsigned", slip, 0.0, 0.02});
  report.bands.push_back(
      {"mean difference of the deepest wheel's sinkage, unsigned, m", sinkage, 0.0, 0.001});
  report.bands.push_back({"mean difference of the largest current, unsigned, A", current, 0.0, 0.03});
  report.notes.push_back(
      "Reasons for the differences: the balance assumes the rover's heading, while the dynamic "
      "rover steers to hold it, so that on side slopes it drives at a small angle to its path; a "
      "wheel's slip follows a change of ground over the length of its contact; the dynamic level "
      "reads the ground at three points under each wheel; and near the traction limit, where a "
      "little more load needs much more slip, all of this is magnified.");
  return report;
}

}  // namespace slipway::validation
