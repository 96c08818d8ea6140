#include "planner/search/bottleneck.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/angle.h"
#include "planner/search/graph_search.h"
#include "planner/search/grid_search.h"

namespace slipway::planner {
namespace {

constexpr double kNoElevation = 100.0, kInKeepOut = 10.0;  // above any ratio to a limit of interest
constexpr double kMaxHoldless = 0.99;                      // a slope within the tilt limit is no breach of it
constexpr double kOneDecimal = 10.0;

// How far a cell, driven in a direction, is from what the limits allow: 0 where it is allowed.
double breach_of(const PlanProblem& problem, const MotionCost& cost, std::size_t index, double heading_rad) {
  const GroundCell& cell = cost.map().cell(index);
  const Eigen::Vector2d place = cost.map().centre_m(index);
  const double tilt = cell.tilt_rad / problem.max_tilt_rad();
  switch (cell.passage) {
    case Passage::kNoData:
      return kNoElevation;
    case Passage::kKeepOut:
      return kInKeepOut;
    case Passage::kSteep:
    case Passage::kRough:
      return std::max(
          {1.0, tilt, (cell.rise_m + problem.limits.min_clearance_m) / problem.rover->belly_clearance_m});
    case Passage::kNearKeepOut:
      if (!cost.map().may_stand({place.x(), place.y(), heading_rad})) return kInKeepOut;
      [[fallthrough]];
    case Passage::kFree:
      break;
  }
  const bool held =
      std::isfinite(cost.per_metre_in_cell(index, std::cos(heading_rad), std::sin(heading_rad)));
  return held ? 0.0 : std::min(tilt, kMaxHoldless);
}

// A step of a way, with the cell that is furthest from the limits at either of its ends.
struct Crossing {
  std::size_t cell = 0;
  double breach = 0.0;
};

struct Breached {
  double worst = 0.0, length_m = 0.0;
  auto operator<=>(const Breached&) const = default;
};

// The cells from one place to another on the way whose worst breach is least; of those, one with little
// breached ground.
std::vector<Crossing> least_breach(const PlanProblem& problem, const MotionCost& cost, const Waypoint& from,
                                   const Waypoint& to) {
  const TraverseMap& map = cost.map();
  const long long start = map.index_at(from.x_m, from.y_m), goal = map.index_at(to.x_m, to.y_m);
  if (start < 0 || goal < 0) return {};
  const auto infinity = std::numeric_limits<double>::infinity();
  std::vector<Breached> best(map.cells(), {infinity, infinity});
  std::vector<Crossing> crossing(map.cells());
  std::vector<std::size_t> before(map.cells(), map.cells());
  const auto leave = [&](std::uint32_t here, const auto& reach) {
    const dem::Cell at = map.place_of(here);
    for (int k = 0; k < 8; ++k) {
      const double heading = k * rad_from_deg(45.0);
      const long long beside = cell_beyond(map, at, 2 * k);
      if (beside < 0) continue;
      const auto next = static_cast<std::size_t>(beside);
      Crossing step{next, breach_of(problem, cost, next, heading)};
      const Crossing leaving{here, breach_of(problem, cost, here, heading)};
      if (leaving.breach > step.breach) step = leaving;
      Breached way{std::max(best[here].worst, step.breach), best[here].length_m};
      way.length_m += (step.breach > 0.0 ? 1.0 : 1e-3) * (k % 2 == 0 ? 1.0 : std::sqrt(2.0)) * map.cell_m();
      if (!(way < best[next])) continue;
      crossing[next] = step;
      before[next] = here;
      reach(static_cast<std::uint32_t>(next), way);
    }
  };
  search_best_first(
      best, static_cast<std::uint32_t>(start), [](std::uint32_t, const Breached& way) { return way; },
      [&](std::uint32_t cell, const Breached&) { return cell == goal; }, leave);
  std::vector<Crossing> way;
  for (auto at = static_cast<std::size_t>(goal); at < map.cells(); at = before[at])
    way.push_back(crossing[at]);
  std::reverse(way.begin(), way.end());
  return way;
}

// The limits that the way would need, each no wider than it needs to be.
struct Relaxed {
  PlanProblem problem;
  std::string words;  // "max_tilt_deg = 27.4 and without keep-out 1"
  bool possible = true;
};

void add(std::string& words, std::string more) {
  words += (words.empty() ? "" : " and ") + std::move(more);
}

// Adds the zone's number where it bars the place to some heading.
void note_in_the_way(const KeepOut& zone, const Eigen::Vector2d& place, std::size_t number,
                     std::vector<std::size_t>& numbers) {
  if (!zone.clear_at_any_heading(place.x(), place.y()) &&
      std::find(numbers.begin(), numbers.end(), number) == numbers.end())
    numbers.push_back(number);
}

// Takes these polygons out, the last first, and says so.
void drop(std::string_view key, std::vector<std::size_t>& numbers, std::vector<Polygon>& polygons,
          std::string& words) {
  std::sort(numbers.rbegin(), numbers.rend());
  for (const std::size_t z : numbers) {
    polygons.erase(polygons.begin() + static_cast<std::ptrdiff_t>(z));
    add(words, fmt::format("no {}/{}", key, z));
  }
}

Relaxed relax(const PlanProblem& problem, const TraverseMap& map, const std::vector<Crossing>& way) {
  Relaxed out{.problem = problem, .words = {}};
  double tilt = 0.0, rise = 0.0;
  std::vector<std::size_t> outs, ins;
  for (const Crossing& crossing : way) {
    if (crossing.breach <= 0.0) continue;
    const GroundCell& cell = map.cell(crossing.cell);
    out.possible &= cell.passage != Passage::kNoData;
    tilt = std::max<double>(tilt, cell.tilt_rad);
    rise = std::max<double>(rise, cell.rise_m);
    const Eigen::Vector2d place = map.centre_m(crossing.cell);
    if (crossing.breach < kInKeepOut) continue;
    for (std::size_t z = 0; z < problem.keep_out.size(); ++z)
      note_in_the_way(KeepOut(std::span(problem.keep_out).subspan(z, 1), *problem.rover), place, z, outs);
    for (std::size_t z = 0; z < problem.keep_in.size(); ++z)
      note_in_the_way(KeepOut({}, *problem.rover, std::span(problem.keep_in).subspan(z, 1)), place, z, ins);
  }
  if (tilt > problem.rover->max_tilt_rad || rise > problem.rover->belly_clearance_m) out.possible = false;
  if (tilt > problem.limits.max_tilt_rad) {
    const double tilt_deg = std::ceil(kOneDecimal * deg_from_rad(tilt) + 1e-3) / kOneDecimal;
    out.problem.limits.max_tilt_rad = std::min(rad_from_deg(tilt_deg), problem.rover->max_tilt_rad);
    add(out.words, fmt::format("max_tilt_deg = {:.1f}", deg_from_rad(out.problem.limits.max_tilt_rad)));
  }
  if (rise + problem.limits.min_clearance_m > problem.rover->belly_clearance_m) {
    out.problem.limits.min_clearance_m =
        std::floor(1000.0 * (problem.rover->belly_clearance_m - rise) - 1e-3) / 1000.0;
    out.possible &= out.problem.limits.min_clearance_m >= 0.0;
    add(out.words, fmt::format("min_clearance_m = {:.3f}", out.problem.limits.min_clearance_m));
  }
  drop("keep_out", outs, out.problem.keep_out, out.words);
  drop("keep_in", ins, out.problem.keep_in, out.words);
  return out;
}

// What a cell asks for that the limits don't allow.
std::string breach_in_words(const PlanProblem& problem, const GroundCell& cell, bool keep_out) {
  if (cell.passage == Passage::kNoData) return "where elevation is missing, or the map ends, near by";
  if (keep_out && problem.keep_in.empty()) return "in or too near to a keep-out";
  if (keep_out)
    return problem.keep_out.empty() ? "outside a keep-in or too near to its edge"
                                    : "in or too near to a keep-out, or outside a keep-in";
  std::string words;
  if (cell.tilt_rad > problem.max_tilt_rad())
    add(words, fmt::format("{:.1f} deg of tilt where {:.1f} is {}", deg_from_rad(cell.tilt_rad),
                           deg_from_rad(problem.max_tilt_rad()),
                           problem.limits.max_tilt_rad > problem.rover->max_tilt_rad ? "the rover's own limit"
                                                                                     : "the limit"));
  const double clearance = problem.rover->belly_clearance_m - cell.rise_m;
  if (clearance < problem.limits.min_clearance_m)
    add(words, fmt::format("ground that leaves the belly {:.2f} m of clearance where {:.2f} is the limit",
                           clearance, problem.limits.min_clearance_m));
  if (words.empty())
    words = fmt::format("a slope of {:.1f} deg that the mean soil does not hold the rover on",
                        deg_from_rad(cell.tilt_rad));
  return words;
}

bool has_way(const PlanProblem& problem, const TraverseMap& like, const Waypoint& from, const Waypoint& to) {
  const KeepOut keep_out(problem.keep_out, *problem.rover, problem.keep_in);
  // A little less, so that the window has the same cells whatever the rounding.
  const dem::Extent window = like.geometry().extent();
  const double little = 0.25 * like.cell_m();
  const TraverseMap map(
      problem, keep_out,
      {window.west_m + little, window.south_m + little, window.east_m - little, window.north_m - little});
  const GroundTables tables = build_ground_tables(problem);
  const MotionCost cost(problem, map, tables, problem.weights);
  const GridSearch grid(cost);
  return !grid.way(grid.cost_to_go(to.x_m, to.y_m), from.x_m, from.y_m).empty();
}

}  // namespace

std::optional<std::string> bottleneck(const PlanProblem& problem, const MotionCost& cost,
                                      const Waypoint& from, const Waypoint& to) {
  const TraverseMap& map = cost.map();
  const std::vector<Crossing> way = least_breach(problem, cost, from, to);
  const auto worst = std::max_element(
      way.begin(), way.end(), [](const Crossing& a, const Crossing& b) { return a.breach < b.breach; });
  if (worst == way.end() || worst->breach <= 0.0) return std::nullopt;
  const Eigen::Vector2d place = map.centre_m(worst->cell);
  const bool in_keep_out = worst->breach >= kInKeepOut && worst->breach < kNoElevation;
  std::string words = fmt::format("every way breaks a limit, the least at ({:.1f}, {:.1f}): {}", place.x(),
                                  place.y(), breach_in_words(problem, map.cell(worst->cell), in_keep_out));
  const Relaxed relaxed = relax(problem, map, way);
  if (!relaxed.possible || relaxed.words.empty()) return words + "; no limit of the request opens a way";
  return words + (has_way(relaxed.problem, map, from, to)
                      ? fmt::format("; with {} there is a way", relaxed.words)
                      : fmt::format("; even with {} the mean soils hold the rover on no way", relaxed.words));
}

std::optional<std::string> zone_on_way(const PlanProblem& problem, const TraverseMap& map,
                                       const std::vector<std::size_t>& way) {
  if (way.size() < 2) return std::nullopt;
  const Eigen::Vector2d before = map.centre_m(way.front());
  const Eigen::Vector2d next = map.centre_m(way[1]) - before;
  Pose2 at{before.x(), before.y(), std::atan2(next.y(), next.x())};
  double driven = 0.0;
  for (std::size_t k = 1; k < way.size(); ++k) {
    const Eigen::Vector2d place = map.centre_m(way[k]);
    const Motion motion = straight(at, place.x(), place.y());
    for (const auto& [key, zones] :
         {std::pair("keep_out", &problem.keep_out), std::pair("keep_in", &problem.keep_in)}) {
      const bool is_out = zones == &problem.keep_out;
      for (std::size_t z = 0; z < zones->size(); ++z) {
        const std::span<const Polygon> one = std::span(*zones).subspan(z, 1), none;
        const KeepOut zone(is_out ? one : none, *problem.rover, is_out ? none : one);
        if (const auto hit = zone.first_hit(motion))
          return fmt::format(
              "{} {} (/{}/{}) closes the way at ({:.1f}, {:.1f}), {:.1f} m from its beginning: the rover's "
              "body does not pass there",
              is_out ? "keep-out" : "keep-in", z + 1, key, z, hit->x_m, hit->y_m, driven);
      }
    }
    driven += motion.length_m;
    at = motion.to;
  }
  return std::nullopt;
}

std::optional<std::string> first_closed(const PlanProblem& problem, const MotionCost& cost,
                                        const std::vector<Motion>& motions) {
  const TraverseMap& map = cost.map();
  for (const Motion& motion : motions) {
    const int pieces = std::max(1, static_cast<int>(std::ceil(2.0 * motion.length_m / map.cell_m())));
    for (int k = 0; k <= pieces; ++k) {
      const Pose2 pose = motion.at(motion.length_m * k / pieces);
      if (std::isfinite(cost.per_metre(pose))) continue;
      const long long at = map.index_at(pose.x_m, pose.y_m);
      if (at < 0) return fmt::format("({:.1f}, {:.1f}) is off the map", pose.x_m, pose.y_m);
      const auto index = static_cast<std::size_t>(at);
      const double breach = breach_of(problem, cost, index, pose.yaw_rad);
      return fmt::format(
          "({:.1f}, {:.1f}), heading {:.0f} deg: {}", pose.x_m, pose.y_m, deg_from_rad(pose.yaw_rad),
          breach_in_words(problem, map.cell(index), breach >= kInKeepOut && breach < kNoElevation));
    }
    if (const auto pose = map.keep_out().first_hit(motion))
      return fmt::format("({:.1f}, {:.1f}): the rover's body would {}", pose->x_m, pose->y_m,
                         trespass_in_words(problem));
  }
  return std::nullopt;
}

}  // namespace slipway::planner
