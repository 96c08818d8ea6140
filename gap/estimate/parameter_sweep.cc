#include "gap/estimate/parameter_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <set>

#include "core/parallel_for.h"

namespace slipway::gap {
namespace {

std::vector<Fault> faults_of(std::span<const SweptParameter> parameters, std::span<const double> weights) {
  std::vector<Fault> faults;
  std::set<std::string> names;
  if (parameters.empty()) faults.push_back({"/parameters", "there is nothing to vary"});
  double coarse = 1.0, fine = 1.0;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const SweptParameter& p = parameters[k];
    const std::string pointer = fmt::format("/parameters/{}", k);
    if (!names.insert(p.name).second)
      faults.push_back({pointer + "/name", fmt::format("\"{}\" is given twice", p.name)});
    if (!(std::isfinite(p.lowest) && std::isfinite(p.highest) && p.lowest < p.highest))
      faults.push_back(
          {pointer + "/lowest", fmt::format("lowest = {}, must be below highest = {}", p.lowest, p.highest)});
    else if (p.logarithmic && !(p.lowest > 0.0))
      faults.push_back(
          {pointer + "/lowest", fmt::format("lowest = {}, must be positive for steps of a ratio", p.lowest)});
    if (p.coarse < 2)
      faults.push_back({pointer + "/coarse", fmt::format("coarse = {}, must be at least 2", p.coarse)});
    if (p.fine < 2)
      faults.push_back({pointer + "/fine", fmt::format("fine = {}, must be at least 2", p.fine)});
    coarse *= p.coarse;
    fine *= p.fine;
  }
  if (weights.empty()) faults.push_back({"", "there is no case to score"});
  const double scores = (coarse + fine) * static_cast<double>(weights.size());
  if (scores > kMaxSweepCases)
    faults.push_back(
        {"/parameters", fmt::format("{} scores are asked for, {} at most: fewer values or parameters", scores,
                                    kMaxSweepCases)});
  return faults;
}

// `count` values from lowest to highest. One that a rounding error parts from a value of `known` is that one.
std::vector<double> axis(const SweptParameter& p, double lowest, double highest, int count,
                         std::span<const double> known) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / (count - 1);
    double value =
        p.logarithmic ? lowest * std::pow(highest / lowest, share) : lowest + share * (highest - lowest);
    if (i == count - 1) value = highest;
    for (const double other : known)
      if (std::abs(value - other) <= 1e-9 * (highest - lowest)) value = other;
    values.push_back(value);
  }
  return values;
}

std::size_t node_count(const std::vector<std::vector<double>>& axes) {
  std::size_t count = 1;
  for (const auto& values : axes) count *= values.size();
  return count;
}

// Index on each axis of a grid's node.
std::vector<std::size_t> place_of(std::size_t node, const std::vector<std::vector<double>>& axes) {
  std::vector<std::size_t> place(axes.size());
  for (std::size_t k = axes.size(); k-- > 0;) {
    place[k] = node % axes[k].size();
    node /= axes[k].size();
  }
  return place;
}

class Sweeper {
 public:
  Sweeper(std::span<const double> weights, const ScoreOfCase& score, std::size_t threads, Progress& progress)
      : weights_(weights),
        case_count_(weights.size()),
        score_(score),
        threads_(threads),
        progress_(progress) {
    for (std::size_t i = 0; i < case_count_; ++i) all_cases_.push_back(i);
  }

  // Tries the points of a grid that are new; false once cancelled. Its progress is from `begin` to `end`.
  bool try_grid(SweepGrid& grid, std::vector<SweepPoint>& points, std::string_view stage, double begin,
                double end) {
    const std::size_t first = points.size();
    for (std::size_t node = 0; node < node_count(grid.axes); ++node) {
      const std::vector<std::size_t> place = place_of(node, grid.axes);
      std::vector<double> x;
      for (std::size_t k = 0; k < place.size(); ++k) x.push_back(grid.axes[k][place[k]]);
      const auto [found, is_new] = known_.try_emplace(x, points.size());
      grid.points.push_back(found->second);
      if (is_new)
        points.push_back(
            {.x = std::move(x), .cases = std::vector<std::optional<double>>(case_count_), .score = {}});
    }
    const std::size_t jobs = (points.size() - first) * case_count_;
    std::atomic<std::size_t> done{0};
    parallel_for(jobs, threads_, [&](std::size_t job) {
      if (progress_.cancelled()) return;
      SweepPoint& point = points[first + job / case_count_];
      const std::optional<double> score = score_(job % case_count_, point.x);
      if (score && std::isfinite(*score)) point.cases[job % case_count_] = score;
      const std::size_t now = ++done;
      progress_.report(stage, begin + (end - begin) * static_cast<double>(now) / static_cast<double>(jobs));
    });
    for (std::size_t i = first; i < points.size(); ++i)
      points[i].score = score_over(points[i], all_cases_, weights_);
    return !progress_.cancelled();
  }

 private:
  std::span<const double> weights_;
  std::size_t case_count_;
  const ScoreOfCase& score_;
  std::size_t threads_;
  Progress& progress_;
  std::vector<std::size_t> all_cases_;
  std::map<std::vector<double>, std::size_t> known_;
};

// The first of the lowest scores; nothing where no point has one.
std::optional<std::size_t> best_of(const std::vector<SweepPoint>& points) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].score && (!best || *points[i].score < *points[*best].score)) best = i;
  return best;
}

// Between the neighbours of the best on each axis of the coarse grid; at an end of an axis, from there on.
SweepGrid grid_around(const ParameterSweep& sweep, std::span<const SweptParameter> parameters) {
  SweepGrid fine;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const std::vector<double>& values = sweep.coarse.axes[k];
    const auto at = std::find(values.begin(), values.end(), sweep.points[sweep.best_coarse].x[k]);
    const auto i = static_cast<std::size_t>(at - values.begin());
    fine.axes.push_back(axis(parameters[k], values[i == 0 ? 0 : i - 1],
                             values[std::min(i + 1, values.size() - 1)], parameters[k].fine, values));
  }
  return fine;
}

}  // namespace

std::optional<double> score_over(const SweepPoint& point, std::span<const std::size_t> cases,
                                 std::span<const double> weights) {
  double squares = 0.0, weight = 0.0;
  for (const std::size_t i : cases) {
    if (!point.cases[i]) return std::nullopt;
    squares += weights[i] * *point.cases[i] * *point.cases[i];
    weight += weights[i];
  }
  return std::sqrt(squares / weight);
}

Result<ParameterSweep> sweep_coarse_then_fine(std::span<const SweptParameter> parameters,
                                              std::span<const double> weights, const ScoreOfCase& score,
                                              std::size_t threads, Progress& progress) {
  if (auto faults = faults_of(parameters, weights); !faults.empty())
    return fail(ErrorCode::kInvalidRequest, "the parameters can't be swept", std::move(faults));
  ParameterSweep sweep;
  sweep.weights.assign(weights.begin(), weights.end());
  std::vector<std::vector<double>> fine_sizes;
  for (const SweptParameter& p : parameters) {
    sweep.names.push_back(p.name);
    sweep.logarithmic.push_back(p.logarithmic);
    sweep.coarse.axes.push_back(axis(p, p.lowest, p.highest, p.coarse, {}));
    fine_sizes.emplace_back(static_cast<std::size_t>(p.fine));
  }
  const auto coarse_nodes = static_cast<double>(node_count(sweep.coarse.axes));
  const double coarse_share = coarse_nodes / (coarse_nodes + static_cast<double>(node_count(fine_sizes)));
  Sweeper sweeper(weights, score, threads, progress);
  if (!sweeper.try_grid(sweep.coarse, sweep.points, "coarse sweep", 0.0, coarse_share))
    return fail(ErrorCode::kCancelled, "the sweep was given up");
  const std::optional<std::size_t> best = best_of(sweep.points);
  if (!best)
    return fail(ErrorCode::kNotConverged, "at every point of the coarse sweep some case has no answer");
  sweep.best_coarse = *best;
  sweep.fine = grid_around(sweep, parameters);
  if (!sweeper.try_grid(sweep.fine, sweep.points, "fine sweep", coarse_share, 1.0))
    return fail(ErrorCode::kCancelled, "the sweep was given up");
  sweep.best = *best_of(sweep.points);
  return sweep;
}

ScoreSurface score_surface(const ParameterSweep& sweep, const SweepGrid& grid, std::size_t x, std::size_t y) {
  ScoreSurface surface{.x = x, .y = y, .x_values = grid.axes[x], .y_values = {}, .scores = {}};
  if (x != y) surface.y_values = grid.axes[y];
  surface.scores.resize(surface.x_values.size() * std::max<std::size_t>(1, surface.y_values.size()));
  for (std::size_t node = 0; node < grid.points.size(); ++node) {
    const std::vector<std::size_t> place = place_of(node, grid.axes);
    const std::optional<double> score = sweep.points[grid.points[node]].score;
    auto& cell = surface.scores[place[x] + (x == y ? 0 : place[y] * surface.x_values.size())];
    if (score && (!cell || *score < *cell)) cell = score;
  }
  return surface;
}

}  // namespace slipway::gap
