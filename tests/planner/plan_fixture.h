#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "dem/ascii_terrain.h"
#include "planner/make_plan.h"
#include "planner/predict_path.h"

namespace slipway::planner {

// A six-wheel rover with the dimensions of data/rovers/zhurong-class.json.
inline std::shared_ptr<const sim::RoverModel> test_rover() {
  auto rover = std::make_shared<sim::RoverModel>();
  rover->name = "test";
  rover->mass_kg = 204.5;
  rover->com_m = {0.0, 0.0, 0.45};
  for (const sim::Side side : {sim::Side::kLeft, sim::Side::kRight}) {
    const bool left = side == sim::Side::kLeft;
    for (const auto& [letter, x] : {std::pair{"f", 0.85}, std::pair{"m", 0.0}, std::pair{"r", -0.85}}) {
      sim::WheelModel wheel;
      wheel.name = std::string(left ? "l" : "r") + letter;
      wheel.radius_m = 0.1475;
      wheel.width_m = 0.2;
      wheel.position_m = {x, left ? 0.62 : -0.62, wheel.radius_m};
      wheel.steerable = true;
      wheel.side = side;
      wheel.on_bogie = x < 0.5;
      rover->wheels.push_back(wheel);
    }
  }
  rover->suspension.rocker_pivot_m = {0.15, 0.5, 0.5};
  rover->suspension.bogie_pivot_m = {-0.42, 0.58, 0.35};
  rover->drive.torque_constant_nm_per_a = 0.1578;
  rover->drive.gear_ratio = 79.3;
  rover->drive.gear_efficiency = 1.0;
  rover->drive.no_load_current_a = 0.0;
  rover->drive.max_wheel_rate_rad_s = 0.436;
  rover->belly_clearance_m = 0.3;
  rover->body_length_m = 2.0;
  rover->body_width_m = 1.45;
  rover->max_tilt_rad = 0.436;
  rover->turn_rate_rad_s = 0.03;
  return rover;
}

inline sim::SoilDistribution firm_soil(std::string name) {
  sim::SoilDistribution soil;
  soil.name = std::move(name);
  soil.mean.pressure = {.k_c = 1400.0, .k_phi = 2'000'000.0, .n = 1.0};
  soil.mean.cohesion_pa = 3000.0;
  soil.mean.friction_angle_rad = 0.61;
  soil.mean.shear_modulus_x_m = soil.mean.shear_modulus_y_m = 0.012;
  soil.std = {.stiffness_ratio = 0.1,
              .n = 0.02,
              .cohesion_pa = 300.0,
              .friction_angle_rad = 0.02,
              .shear_modulus_ratio = 0.1};
  return soil;
}

// Loose: slips twice as much on the level and gives up some 8 deg earlier.
inline sim::SoilDistribution soft_soil(std::string name) {
  sim::SoilDistribution soil = firm_soil(std::move(name));
  soil.mean.pressure = {.k_c = 1400.0, .k_phi = 400'000.0, .n = 1.0};
  soil.mean.cohesion_pa = 500.0;
  soil.mean.friction_angle_rad = 0.45;
  soil.mean.shear_modulus_x_m = soil.mean.shear_modulus_y_m = 0.02;
  return soil;
}

// From 'S' to 'G' of a drawing: 'a' firm, 's' soft, '?' unknown, else firm.
inline PlanProblem problem_of(std::string_view drawing, double cell_m = 2.0, double height_step_m = 0.25) {
  const auto ascii = dem::parse_ascii_terrain(drawing, {.cell_m = cell_m,
                                                        .height_step_m = height_step_m,
                                                        .default_soil = "firm",
                                                        .soils = {{'a', "firm"}, {'s', "soft"}}});
  PlanProblem problem;
  problem.terrain = ascii.value().terrain;
  problem.soil_map = ascii->soil_map;
  for (const std::string& name : problem.soil_map->soils())
    problem.beliefs.known.push_back(name == "soft" ? soft_soil(name) : firm_soil(name));
  problem.beliefs.unknown = soft_soil("unknown");
  problem.rover = test_rover();
  if (ascii->start) problem.start = {ascii->start->x_m, ascii->start->y_m, std::nullopt};
  if (ascii->goal) problem.goal = {ascii->goal->x_m, ascii->goal->y_m, std::nullopt};
  problem.limits.max_sinkage_m = 0.2;
  problem.limits.max_current_a = 20.0;
  problem.risk.draws = 4;
  // That a clean draw keeps.
  problem.risk.bars = {.max_stop = 0.9, .no_go_stop = 0.9, .max_immobilised = 0.9, .max_embedding = 0.9};
  return problem;
}

}  // namespace slipway::planner
