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
      : on_slopes(problem.drive, belief, unknown,
                  with_risk ? std::optional(problem.distance_m) : std::nullopt) {
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

// Of a drive: a longer one is taken to go where the ground is as around its middle.
constexpr double kMaxReach_m = 10.0;

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
  if (is_of_soil_alone(problem_.kind)) return 0;
  return reach_in_cells(*problem_.drive.rover, geometry) +
         drive_reach(std::min(geometry.cell_x_m, geometry.cell_y_m));
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
  if (problem_.kind == MapKind::kEmbeddingRisk) return rounded(worst.embedding);
  return rounded(too_steep ? 1.0 : worst.stop);
}

bool CellMap::may_drive(double gradient_x, double gradient_y, double rise_m) const {
  const PlanProblem& drive = problem_.drive;
  return std::hypot(gradient_x, gradient_y) <= std::tan(drive.max_tilt_rad()) &&
         rise_m + drive.limits.min_clearance_m <= drive.rover->belly_clearance_m;
}

float CellMap::verdict_on(const Ground& ground, double gradient_x, double gradient_y) const {
  const auto class_of = [](double severity) {
    return static_cast<float>(severity < 0.5   ? map_class::kGo
                              : severity < 1.5 ? map_class::kVerdictUnknown
                                               : map_class::kNoGo);
  };
  if (problem_.heading_rad) {
    const double c = std::cos(*problem_.heading_rad), s = std::sin(*problem_.heading_rad);
    return class_of(
        ground.by_heading->at(c * gradient_x + s * gradient_y, -s * gradient_x + c * gradient_y).severity);
  }
  const FiguresBySlope::Range range = ground.by_slope->at(std::hypot(gradient_x, gradient_y));
  if (range.least.severity < 0.5 && range.greatest.severity > 0.5)
    return static_cast<float>(map_class::kGoInSomeHeadings);
  return class_of(range.least.severity);
}

// How far a drive of the map's distance with its middle in a cell reaches.
int CellMap::drive_reach(double cell_m) const {
  return problem_.kind == MapKind::kVerdict
             ? static_cast<int>(std::lround(std::min(0.5 * problem_.distance_m, kMaxReach_m) / cell_m))
             : 0;
}

float CellMap::own_value(const dem::SoilMap& soils, const CellGround& cells, std::size_t i,
                         const Eigen::Vector2d& centre, std::vector<const Ground*>& known) const {
  const bool verdict = problem_.kind == MapKind::kVerdict;
  const std::optional<std::size_t> soil = soils.soil_at(centre.x(), centre.y());
  const double gradient_x = cells.gradient_x[i], gradient_y = cells.gradient_y[i];
  if (std::isnan(gradient_x)) return verdict ? static_cast<float>(map_class::kNoElevation) : kNoMapValue;
  if (verdict && !may_drive(gradient_x, gradient_y, cells.rise_m[i])) return map_class::kNoGo;
  if (!verdict && !soil && !problem_.price_unknown) return kNoMapValue;
  const Ground*& ground = known[soil.value_or(known.size() - 1)];
  if (ground == nullptr) ground = &ground_of(soil);
  return verdict ? verdict_on(*ground, gradient_x, gradient_y) : value_on(*ground, gradient_x, gradient_y);
}

// A cell is a GO where all that the drive meets is: along its heading, or within its reach in any heading.
void CellMap::take_worst_on_way(const dem::CellWindow& window, int reach_x, int reach_y,
                                const std::vector<float>& own, std::vector<float>& out) const {
  const int wide = window.columns + 2 * reach_x;
  const auto at = [&](int row, int column) {
    return own[static_cast<std::size_t>((row + reach_y) * wide + column + reach_x)];
  };
  for (int r = 0; r < window.rows; ++r) {
    for (int c = 0; c < window.columns; ++c) {
      float& value = out[static_cast<std::size_t>(r * window.columns + c)] = at(r, c);
      if (value != static_cast<float>(map_class::kGo)) continue;
      for (int dr = -reach_y; dr <= reach_y; ++dr)
        for (int dc = -reach_x; dc <= reach_x; ++dc)
          if (is_on_way(dr, dc, reach_x, reach_y)) value = worse(value, at(r + dr, c + dc));
    }
  }
}

bool CellMap::is_on_way(int down, int right, int reach_x, int reach_y) const {
  const double x = static_cast<double>(right) / std::max(1, reach_x);
  const double y = -static_cast<double>(down) / std::max(1, reach_y);
  if (x * x + y * y > 1.0) return false;
  if (!problem_.heading_rad) return true;
  const double off = -right * std::sin(*problem_.heading_rad) - down * std::cos(*problem_.heading_rad);
  return std::abs(off) <= 0.5;
}

// Of a GO whose way meets another cell. In any heading, a way that is none there need not meet it.
float CellMap::worse(float here, float there) const {
  if (there == static_cast<float>(map_class::kNoElevation) || there == static_cast<float>(map_class::kGo))
    return here;
  return problem_.heading_rad ? std::max(here, there) : static_cast<float>(map_class::kGoInSomeHeadings);
}

std::vector<float> CellMap::values(const dem::Terrain& terrain, const dem::SoilMap& soils,
                                   const dem::CellWindow& window, const dem::Extent& map) const {
  const bool of_soil = is_of_soil_alone(problem_.kind), verdict = problem_.kind == MapKind::kVerdict;
  const dem::GridGeometry& g = terrain.geometry();
  const int reach_x = drive_reach(g.cell_x_m), reach_y = drive_reach(g.cell_y_m);
  const dem::CellWindow wider{window.row - reach_y, window.column - reach_x, window.rows + 2 * reach_y,
                              window.columns + 2 * reach_x};
  CellGround cells;
  if (!of_soil) cells = cell_ground(terrain, wider, map, *problem_.drive.rover, verdict);
  std::vector<float> own(static_cast<std::size_t>(wider.rows) * static_cast<std::size_t>(wider.columns));
  std::vector<const Ground*> known(grounds_.size(), nullptr);  // asked for under the lock once
  std::size_t i = 0;
  for (int r = 0; r < wider.rows; ++r) {
    for (int c = 0; c < wider.columns; ++c, ++i) {
      const dem::Cell cell{wider.row + r, wider.column + c};
      const Eigen::Vector2d centre = g.centre_m(cell);
      own[i] = of_soil ? class_of_soil(soils.soil_at(centre.x(), centre.y()), terrain.has_data(cell))
                       : own_value(soils, cells, i, centre, known);
    }
  }
  if (reach_x == 0 && reach_y == 0) return own;
  std::vector<float> out(static_cast<std::size_t>(window.rows) * static_cast<std::size_t>(window.columns));
  take_worst_on_way(window, reach_x, reach_y, own, out);
  return out;
}

}  // namespace slipway::planner
