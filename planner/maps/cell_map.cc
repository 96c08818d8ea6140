#include "planner/maps/cell_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "planner/maps/cell_ground.h"

namespace slipway::planner {

struct CellMap::Ground {
  Ground(const CellMapProblem& problem, const sim::SoilDistribution& belief, bool unknown, bool with_risk)
      : on_slopes(problem.drive, belief, unknown, with_risk) {
    if (!problem.heading_rad)
      by_slope.emplace(on_slopes, with_risk);
    else if (with_risk)
      by_heading.emplace(on_slopes);
  }

  GroundOnSlopes on_slopes;
  std::optional<FiguresBySlope> by_slope;
  std::optional<FiguresByHeading> by_heading;
};

namespace {

// To 14 bits after the first one: the rest says nothing and would not compress.
float rounded(double value) {
  constexpr std::uint32_t kDropped = (1U << 9U) - 1U, kHalf = 1U << 8U;
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  return std::bit_cast<float>((bits + kHalf) & ~kDropped);
}

bool needs_risk(MapKind kind) {
  return kind == MapKind::kStopRisk || kind == MapKind::kEmbeddingRisk || kind == MapKind::kVerdict;
}

bool is_of_soil_alone(MapKind kind) {
  return kind == MapKind::kBelief || kind == MapKind::kUnknown;
}

}  // namespace

CellMap::CellMap(CellMapProblem problem)
    : problem_(std::move(problem)),
      with_risk_(needs_risk(problem_.kind)),
      grounds_(problem_.drive.beliefs.known.size() + 1) {}

CellMap::~CellMap() = default;

int CellMap::margin(const dem::GridGeometry& geometry) const {
  return is_of_soil_alone(problem_.kind) ? 0 : reach_in_cells(*problem_.drive.rover, geometry);
}

const CellMap::Ground& CellMap::ground_of(std::optional<std::size_t> soil) const {
  const sim::SoilBeliefs& beliefs = problem_.drive.beliefs;
  const std::size_t place = soil.value_or(beliefs.known.size());
  const std::lock_guard lock(mutex_);
  std::unique_ptr<const Ground>& ground = grounds_[place];
  if (!ground)
    ground = std::make_unique<const Ground>(problem_, soil ? beliefs.known[*soil] : beliefs.unknown, !soil,
                                            with_risk_);
  return *ground;
}

float CellMap::class_of_soil(std::optional<std::size_t> soil, bool has_elevation) const {
  if (problem_.kind == MapKind::kUnknown) {
    if (!has_elevation) return map_class::kWithoutElevation;
    return soil ? map_class::kKnownGround : map_class::kUnknownGround;
  }
  if (!has_elevation) return map_class::kNothing;
  return soil ? static_cast<float>(*soil + 1) : static_cast<float>(map_class::kBeliefUnknown);
}

float CellMap::value_on(const Ground& ground, double gradient_x, double gradient_y) const {
  const double slope = std::hypot(gradient_x, gradient_y);
  const bool too_steep = slope > std::tan(problem_.drive.max_tilt_rad());
  SlopeFigures worst;
  if (problem_.heading_rad) {
    const double c = std::cos(*problem_.heading_rad), s = std::sin(*problem_.heading_rad);
    const double uphill = c * gradient_x + s * gradient_y, leftward = -s * gradient_x + c * gradient_y;
    if (problem_.kind == MapKind::kSlip)
      return rounded(slope > std::tan(kMaxMapSlope_rad) ? 1.0 : ground.on_slopes.slip_at(uphill, leftward));
    worst = ground.by_heading->at(uphill, leftward);
  } else {
    const FiguresBySlope::Range range = ground.by_slope->at(slope);
    if (problem_.kind == MapKind::kSlipBest) return rounded(range.least.slip);
    worst = range.greatest;
  }
  if (problem_.kind == MapKind::kSlipWorst) return rounded(worst.slip);
  if (problem_.kind == MapKind::kEmbeddingRisk)
    return rounded(ground.on_slopes.over(problem_.distance_m, worst.embedding));
  return rounded(too_steep ? 1.0 : ground.on_slopes.over(problem_.distance_m, worst.stop));
}

bool CellMap::may_drive(double gradient_x, double gradient_y, double rise_m) const {
  const PlanProblem& drive = problem_.drive;
  return std::hypot(gradient_x, gradient_y) <= std::tan(drive.max_tilt_rad()) &&
         rise_m + drive.limits.min_clearance_m <= drive.rover->belly_clearance_m;
}

float CellMap::verdict_on(const Ground& ground, double gradient_x, double gradient_y) const {
  const sim::OutcomeBars& bars = problem_.drive.risk.bars;
  const auto keeps_bars = [&](const SlopeFigures& figures) {
    return ground.on_slopes.over(problem_.distance_m, figures.embedding) < bars.max_embedding &&
           ground.on_slopes.over(problem_.distance_m, figures.stop) < bars.max_stop;
  };
  if (problem_.heading_rad) {
    const double c = std::cos(*problem_.heading_rad), s = std::sin(*problem_.heading_rad);
    const SlopeFigures at =
        ground.by_heading->at(c * gradient_x + s * gradient_y, -s * gradient_x + c * gradient_y);
    return keeps_bars(at) ? map_class::kGo : map_class::kNoGo;
  }
  const FiguresBySlope::Range range = ground.by_slope->at(std::hypot(gradient_x, gradient_y));
  if (keeps_bars(range.greatest)) return map_class::kGo;
  return keeps_bars(range.least) ? map_class::kGoInSomeHeadings : map_class::kNoGo;
}

std::vector<float> CellMap::values(const dem::Terrain& terrain, const dem::SoilMap& soils,
                                   const dem::CellWindow& window, const dem::Extent& map) const {
  const bool of_soil = is_of_soil_alone(problem_.kind), verdict = problem_.kind == MapKind::kVerdict;
  CellGround cells;
  if (!of_soil) cells = cell_ground(terrain, window, map, *problem_.drive.rover, verdict);
  std::vector<float> out(static_cast<std::size_t>(window.rows) * static_cast<std::size_t>(window.columns));
  std::vector<const Ground*> known(grounds_.size(), nullptr);  // asked for under the lock once
  std::size_t i = 0;
  for (int r = 0; r < window.rows; ++r) {
    for (int c = 0; c < window.columns; ++c, ++i) {
      const dem::Cell cell{window.row + r, window.column + c};
      const Eigen::Vector2d centre = terrain.geometry().centre_m(cell);
      const std::optional<std::size_t> soil = soils.soil_at(centre.x(), centre.y());
      if (of_soil) {
        out[i] = class_of_soil(soil, terrain.has_data(cell));
        continue;
      }
      const double gradient_x = cells.gradient_x[i], gradient_y = cells.gradient_y[i];
      if (std::isnan(gradient_x) || (!soil && !verdict && !problem_.price_unknown)) {
        out[i] = verdict ? static_cast<float>(map_class::kNoElevation) : kNoMapValue;
        continue;
      }
      if (verdict && (!soil || !may_drive(gradient_x, gradient_y, cells.rise_m[i]))) {
        out[i] = may_drive(gradient_x, gradient_y, cells.rise_m[i])
                     ? static_cast<float>(map_class::kVerdictUnknown)
                     : static_cast<float>(map_class::kNoGo);
        continue;
      }
      const Ground*& ground = known[soil.value_or(known.size() - 1)];
      if (ground == nullptr) ground = &ground_of(soil);
      out[i] =
          verdict ? verdict_on(*ground, gradient_x, gradient_y) : value_on(*ground, gradient_x, gradient_y);
    }
  }
  return out;
}

}  // namespace slipway::planner
