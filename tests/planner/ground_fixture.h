#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/random.h"
#include "tests/planner/plan_fixture.h"

namespace slipway::planner {

// Ground by a height over (x, y); a NaN is a missing cell. Its south-west corner is the origin; all of it is
// firm.
inline PlanProblem problem_on(int rows, int columns, double cell_x_m, double cell_y_m,
                              const std::function<double(double, double)>& height_m) {
  const dem::GridGeometry g{rows, columns, 0.0, rows * cell_y_m, cell_x_m, cell_y_m};
  std::vector<float> heights;
  std::vector<std::uint8_t> valid;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Eigen::Vector2d place = g.centre_m({row, column});
      const double height = height_m(place.x(), place.y());
      valid.push_back(std::isnan(height) ? 0 : 1);
      heights.push_back(std::isnan(height) ? 0.0F : static_cast<float>(height));
    }
  }
  PlanProblem problem = problem_of("S . .\n. . .\n. . G\n");
  const auto cells = heights.size();
  problem.terrain = std::make_shared<dem::Terrain>(g, std::move(heights), std::move(valid));
  problem.soil_map = std::make_shared<dem::SoilMap>(g, std::vector<std::int16_t>(cells, 0),
                                                    std::vector<std::uint8_t>(cells, 1),
                                                    std::vector<dem::SoilClass>{{0, "a", "firm"}});
  problem.beliefs.known = {firm_soil("firm")};
  return problem;
}

// Single cells of the grid that stand out of the level, a share of all of them.
inline double rock_m(double x_m, double y_m, double cell_x_m, double cell_y_m, double share) {
  const auto at = static_cast<std::uint64_t>(std::floor(x_m / cell_x_m)) * 100'003U +
                  static_cast<std::uint64_t>(std::floor(y_m / cell_y_m));
  return random_uniform(random_key(7, at), 0) < share ? 0.9 : 0.0;
}

inline Plan plan_on(const PlanProblem& problem) {
  NoProgress progress;
  Result<Plan> plan = make_plan(problem, progress);
  EXPECT_TRUE(plan.has_value()) << plan.error().detail;
  return plan.value_or(Plan{});
}

}  // namespace slipway::planner
