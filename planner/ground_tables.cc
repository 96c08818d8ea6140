#include "planner/ground_tables.h"

#include <algorithm>

#include "core/angle.h"
#include "core/parallel_for.h"

namespace slipway::planner {
namespace {

// Slip doubles over some 4 deg of slope, so that bilinear blends between these nodes are within a few per cent.
constexpr double kNodeStep_rad = rad_from_deg(2.5);

}  // namespace

sim::Soil weak_soil(const sim::SoilDistribution& belief) {
  sim::SoilNormals normals = sim::SoilNormals::Zero();
  normals << -0.5, 0.0, -0.5, -0.5, 0.5;  // of length one
  return sim::draw_soil(belief, normals);
}

GroundTables build_ground_tables(const PlanProblem& problem) {
  const std::size_t kinds = problem.beliefs.known.size() + 1;
  const double limit = std::min(problem.limits.max_tilt_rad, problem.rover->max_tilt_rad);
  std::vector<std::optional<sim::SlipTable>> tables(2 * kinds);
  const auto belief = [&](std::size_t kind) -> const sim::SoilDistribution& {
    return kind + 1 < kinds ? problem.beliefs.known[kind] : problem.beliefs.unknown;
  };
  parallel_for(tables.size(), problem.threads, [&](std::size_t i) {
    const sim::SoilDistribution& of = belief(i / 2);
    const sim::Soil soil = i % 2 == 0 ? of.mean : weak_soil(of);
    tables[i].emplace(*problem.rover, problem.gravity_m_s2, soil, limit, kNodeStep_rad);
  });
  GroundTables all;
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    GroundTable table{std::move(*tables[2 * kind]), std::move(*tables[2 * kind + 1]),
                      belief(kind).correlation_length_m};
    if (kind + 1 < kinds) {
      all.known.emplace_back(std::move(table));
    } else {
      all.unknown.emplace(std::move(table));
    }
  }
  return all;
}

}  // namespace slipway::planner
