#include "bench/gale_site.h"

#include <memory>

#include "api/soil_beliefs.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::bench {

Site gale() {
  const auto catalogue = api::load_catalogue(SLIPWAY_SOURCE_DIR "/data").value();
  const api::TerrainSite& site = *catalogue.terrains.at("gale");
  const sim::RoverModel& rover = *catalogue.rovers.at("msl-class");
  const auto ground = site.read(site.info().geometry.extent()).value();
  const std::vector<sim::EffectSetting> effects = sim::in_force(rover.effects, {});
  Site out;
  planner::PlanProblem& problem = out.problem;
  auto driven = std::make_shared<sim::RoverModel>(rover);
  sim::apply_effects(effects, *driven);
  problem.rover = driven;
  problem.terrain = ground.terrain;
  const api::RegionalSoils soils =
      api::soils_in_regions(ground.soil_map, sim::effect_regions(effects), std::string(api::kUnknownGround));
  problem.soil_map = soils.map;
  for (const api::RegionalSoil& soil : soils.soils)
    problem.beliefs.known.push_back(api::believed(
        catalogue, soil, site.description().legends.front().confidence, api::kUnknownGround, effects));
  problem.beliefs.unknown =
      api::believed(catalogue, {std::string(api::kUnknownGround), {}}, 1.0, api::kUnknownGround, effects);
  problem.gravity_m_s2 = site.description().gravity_m_s2;
  out.stops = site.stops();
  return out;
}

}  // namespace slipway::bench
