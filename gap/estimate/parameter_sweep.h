#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"

namespace slipway::gap {

// A number that a sweep varies, in the caller's own unit.
struct SweptParameter {
  std::string name;  // unique
  double lowest = 0.0, highest = 1.0;
  int coarse = 5, fine = 5;  // values in each of the two grids, both ends included
  bool logarithmic = false;  // values a constant ratio apart, for what spans decades
};

// How badly the model does in one case at x: 0 is perfect, the rest >= 0. Nothing where the model has no
// answer there. Called from several threads at once.
using ScoreOfCase = std::function<std::optional<double>(std::size_t number, std::span<const double> x)>;

// One parameter vector as tried.
struct SweepPoint {
  std::vector<double> x;                     // in the order of the parameters
  std::vector<std::optional<double>> cases;  // score of each case
  // Weighted root mean square over the cases; nothing where a case has no answer: such a point is never the
  // best.
  std::optional<double> score;
};

// Indices into ParameterSweep::points over a grid; the last parameter varies fastest.
struct SweepGrid {
  std::vector<std::vector<double>> axes;  // values of each parameter, rising
  std::vector<std::size_t> points;
};

struct ParameterSweep {
  std::vector<std::string> names;
  std::vector<bool> logarithmic;   // of the parameters
  std::vector<double> weights;     // of the cases
  std::vector<SweepPoint> points;  // those of the coarse grid, then what the fine one adds
  SweepGrid coarse, fine;
  std::size_t best_coarse = 0, best = 0;  // indices into points; the first among equals
};

// Weighted root mean square of the scores of these cases at a point; nothing where one of them is missing.
std::optional<double> score_over(const SweepPoint& point, std::span<const std::size_t> cases,
                                 std::span<const double> weights);

// Scores every point of a grid over the whole ranges, then of one between the neighbours of its best; a point
// of both is tried once. `weights` says how much each case counts, > 0. Points and cases are spread over
// threads (0: as many as the machine has), the result does not depend on their number.
//
// Errors: invalid_request for parameters that can't be swept ("/parameters/0/lowest") or more than
// kMaxSweepCases scores; not_converged where no point of the coarse grid has a score; cancelled.
Result<ParameterSweep> sweep_coarse_then_fine(std::span<const SweptParameter> parameters,
                                              std::span<const double> weights, const ScoreOfCase& score,
                                              std::size_t threads, Progress& progress);
constexpr double kMaxSweepCases = 1e6;

// The score surface over two parameters: at each pair of their values the best score that the others allow
// (its profile, where there are more than two). Over one parameter where `x` and `y` are the same: a row.
struct ScoreSurface {
  std::size_t x = 0, y = 0;  // parameters
  std::vector<double> x_values, y_values;
  std::vector<std::optional<double>> scores;  // row by row from the lowest y
};

ScoreSurface score_surface(const ParameterSweep& sweep, const SweepGrid& grid, std::size_t x, std::size_t y);

}  // namespace slipway::gap
