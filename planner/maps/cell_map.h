#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "dem/soil_map.h"
#include "dem/terrain.h"
#include "planner/maps/cell_ground.h"
#include "planner/maps/map_kind.h"
#include "planner/maps/slope_figures.h"
#include "planner/problem/problem.h"

namespace slipway::planner {

// A map of each cell by itself. Its ground comes piece by piece: terrain and soil map of the problem are not
// looked at.
struct CellMapProblem {
  PlanProblem drive;
  MapKind kind = MapKind::kSlipBest;
  std::optional<double> heading_rad;  // of travel, counter-clockwise from east; empty: all headings
  double distance_m = 10.0;           // of the drive that a risk or verdict is of
  bool price_unknown = false;         // unknown ground by its belief; otherwise it has no value
};

// kNoValue of maps that are no classes; such cells are nodata.
inline constexpr float kNoMapValue = -9999.0F;

// Thread-safe. The tables of each kind of ground are made when the first cell of it is met.
class CellMap {
 public:
  explicit CellMap(CellMapProblem problem);
  ~CellMap();
  CellMap(const CellMap&) = delete;
  CellMap& operator=(const CellMap&) = delete;

  const CellMapProblem& problem() const { return problem_; }
  // How many cells around a window its values depend on.
  int margin(const dem::GridGeometry& geometry) const;
  // The values of the window's cells, row by row; classes as whole numbers. The window counts in the
  // terrain's cells; the soil map covers it; `map` is where the whole map ends.
  std::vector<float> values(const dem::Terrain& terrain, const dem::SoilMap& soils,
                            const dem::CellWindow& window, const dem::Extent& map) const;

 private:
  struct Ground;  // the tables of one kind
  const Ground& ground_of(std::optional<std::size_t> soil) const;
  float class_of_soil(std::optional<std::size_t> soil, bool has_elevation) const;
  float value_on(const Ground& ground, double gradient_x, double gradient_y) const;
  // The shape of the ground alone forbids nothing.
  bool may_drive(double gradient_x, double gradient_y, double rise_m) const;
  float verdict_on(const Ground& ground, double gradient_x, double gradient_y) const;
  int drive_reach(double cell_m) const;
  // Of a cell by itself.
  float own_value(const dem::SoilMap& soils, const CellGround& cells, std::size_t i,
                  const Eigen::Vector2d& centre, std::vector<const Ground*>& known) const;
  void take_worst_on_way(const dem::CellWindow& window, int reach_x, int reach_y,
                         const std::vector<float>& own, std::vector<float>& out) const;
  bool is_on_way(int down, int right, int reach_x, int reach_y) const;
  float worse(float here, float there) const;

  CellMapProblem problem_;
  bool with_risk_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<const Ground>> grounds_;  // the last one is unknown ground
};

}  // namespace slipway::planner
