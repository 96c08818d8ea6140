#include "api/steps/step_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/files/terrain_site.h"
#include "core/angle.h"
#include "core/fault_words.h"

namespace slipway::api {
namespace {

steps::ChainStep chain_step(const steps::SlipStep& step) {
  return {.pitch_rad = step.climb_rad().value_or(0.0),
          .roll_rad = step.attitude == steps::StepAttitude::kNone ? 0.0 : step.roll_rad(),
          .length_m = step.odometry_m,
          .slip = step.slip};
}

// Where steps lie on a terrain, and what it says of them.
class MappedSteps {
 public:
  static Result<MappedSteps> open(const TerrainSite& site, const std::string& legend,
                                  std::span<const steps::SlipStep> steps) {
    dem::Extent extent{1e300, 1e300, -1e300, -1e300};
    const dem::Extent map = site.info().geometry.extent();
    bool any = false;
    for (const steps::SlipStep& step : steps) {
      if (!step.x_eqc_m || !step.y_eqc_m || !map.contains(*step.x_eqc_m, *step.y_eqc_m)) continue;
      any = true;
      extent.west_m = std::min(extent.west_m, *step.x_eqc_m - kMargin_m);
      extent.east_m = std::max(extent.east_m, *step.x_eqc_m + kMargin_m);
      extent.south_m = std::min(extent.south_m, *step.y_eqc_m - kMargin_m);
      extent.north_m = std::max(extent.north_m, *step.y_eqc_m + kMargin_m);
    }
    if (!any)
      return fail(ErrorCode::kInvalidRequest,
                  fmt::format("no step lies on terrain {}: x_eqc_m and y_eqc_m must be in its map",
                              in_quotes(site.description().name)));
    auto window = site.read(extent, *site.description().legend(legend));
    if (!window) return fail(window.error());
    return MappedSteps(std::move(*window));
  }

  // Slope along the step over this far to either side, and across it; nothing off the map.
  std::optional<steps::ChainStep> at(const steps::SlipStep& step) const {
    constexpr double kReach_m = 1.4;  // about half of the rover's wheelbase
    if (!step.x_eqc_m || !step.y_eqc_m || !step.course_rad) return std::nullopt;
    const double east = std::sin(*step.course_rad), north = std::cos(*step.course_rad);
    const auto slope = [&](double dx, double dy) -> std::optional<double> {
      const auto ahead =
          window_.terrain->height_m(*step.x_eqc_m + kReach_m * dx, *step.y_eqc_m + kReach_m * dy);
      const auto behind =
          window_.terrain->height_m(*step.x_eqc_m - kReach_m * dx, *step.y_eqc_m - kReach_m * dy);
      if (!ahead || !behind) return std::nullopt;
      return std::atan2(*ahead - *behind, 2.0 * kReach_m);
    };
    const auto along = slope(east, north), across = slope(north, -east);
    if (!along || !across) return std::nullopt;
    steps::ChainStep out = chain_step(step);
    out.pitch_rad = *along;
    out.roll_rad = *across;
    const auto soil =
        window_.soil_map ? window_.soil_map->soil_at(*step.x_eqc_m, *step.y_eqc_m) : std::nullopt;
    out.ground = soil ? *soil + 1 : 0;
    return out;
  }
  std::vector<std::string> soils() const {
    return window_.soil_map ? window_.soil_map->soils() : std::vector<std::string>{};
  }

 private:
  static constexpr double kMargin_m = 5.0;
  explicit MappedSteps(GroundWindow window) : window_(std::move(window)) {}
  GroundWindow window_;
};

}  // namespace

Result<std::shared_ptr<const sim::RoverModel>> rover_that_made_steps(const Catalogue& catalogue,
                                                                     const std::string& name) {
  const auto rover = catalogue.rovers.find(name);
  if (rover != catalogue.rovers.end()) return rover->second;
  return fail(ErrorCode::kInvalidRequest, "the rover that made the steps is not known",
              {{"/rover", unknown_rover(catalogue, name)}});
}

std::vector<std::vector<steps::ChainStep>> ways_of(std::span<const steps::SlipStep> steps) {
  std::vector<std::vector<steps::ChainStep>> ways;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (i == 0 || steps[i].sol != steps[i - 1].sol) ways.emplace_back();
    ways.back().push_back(chain_step(steps[i]));
  }
  return ways;
}

Result<StepComparison> compare_steps(const Catalogue& catalogue, const StepComparisonRequest& request,
                                     std::span<const steps::SlipStep> steps) {
  std::vector<Fault> faults;
  const auto rover = rover_that_made_steps(catalogue, request.rover);
  if (!rover) faults = rover.error().faults;
  const auto terrain = catalogue.terrains.find(request.terrain);
  if (!request.terrain.empty() && terrain == catalogue.terrains.end())
    faults.push_back({"/terrain", unknown_terrain(catalogue, request.terrain)});
  else if (!request.legend.empty() &&
           (request.terrain.empty() || !terrain->second->description().legend(request.legend)))
    faults.push_back({"/legend", fmt::format("the terrain has no legend {}", in_quotes(request.legend))});
  if (!faults.empty())
    return fail(ErrorCode::kInvalidRequest, "the comparison can't be made", std::move(faults));

  StepComparison out;
  std::optional<MappedSteps> mapped;
  double gravity_m_s2 = request.gravity_m_s2;
  if (!request.terrain.empty()) {
    auto opened = MappedSteps::open(*terrain->second, request.legend, steps);
    if (!opened) return fail(opened.error());
    mapped.emplace(std::move(*opened));
    gravity_m_s2 = terrain->second->description().gravity_m_s2;
  }
  std::vector<const sim::SoilDistribution*> beliefs{
      &catalogue.soils.find(unknown_ground_at(gravity_m_s2))->second};
  if (mapped)
    for (const std::string& soil : mapped->soils()) beliefs.push_back(&catalogue.soils.find(soil)->second);
  for (const sim::SoilDistribution* belief : beliefs) out.grounds.push_back(belief->name);

  for (const steps::SlipStep& step : steps) {
    const std::optional<steps::ChainStep> here = mapped ? mapped->at(step) : chain_step(step);
    out.without_pitch += !mapped && !step.climb_rad() ? 1 : 0;
    if (!here) {
      ++out.off_map;
      out.places.emplace_back();
      continue;
    }
    if (out.sols.empty() || out.sols.back().sol != step.sol) out.sols.push_back({step.sol, {}, {}});
    out.places.push_back(StepComparison::Place{out.sols.size() - 1, out.sols.back().steps.size()});
    out.sols.back().steps.push_back(*here);
  }
  const steps::GroundChain chain(**rover, gravity_m_s2, beliefs);
  steps::StepForecaster forecaster(chain, request.learning);
  for (steps::ScoredSol& sol : out.sols) sol.forecast = forecaster.next_sol(sol.steps);
  out.scores = steps::score(out.sols);
  return out;
}

}  // namespace slipway::api
