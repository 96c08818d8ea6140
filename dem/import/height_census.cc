#include "dem/import/height_census.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace slipway::dem {
namespace {

constexpr std::size_t kMostHeights = 50'000;  // that are counted: more different ones are ground
constexpr double kLargeShare = 0.2;
// A step is a cliff where it is steeper than any slope that keeps loose ground, or far from what is usual
// here.
constexpr double kCliffGrade = 3.0, kUnusualGrade = 0.5, kTimesUsual = 20.0;
constexpr double kTerraces = 3.5;     // steps of so many quanta come of rounding
constexpr double kLeastStep_m = 5.0;  // unless the stretch is a large part of the map
constexpr double kLeastShare = 0.01;  // which is so large
constexpr long long kLeastCells = 8, kLeastEdges = 4;
constexpr std::size_t kMostFindings = 4;

}  // namespace

HeightCensus::HeightCensus(int columns, double cell_m, double quantum_m)
    : columns_(columns), cell_m_(cell_m), quantum_m_(quantum_m) {}

void HeightCensus::add_row(const float* heights_m, float none) {
  none_ = none;
  std::swap(above_, middle_);
  std::swap(middle_, last_);
  last_.heights_m.assign(heights_m, heights_m + columns_);
  last_.is_constant.assign(static_cast<std::size_t>(columns_), 0);
  for (const float height : last_.heights_m) {
    if (height == none) continue;
    if (heights_++ == 0) first_m_ = height;
    is_flat_ = is_flat_ && height == first_m_;
  }
  ++rows_;
  if (rows_ > 1) finish_middle_row();
}

// The row before the last one now has all of its neighbours.
void HeightCensus::finish_middle_row() {
  const auto same = [&](const Row& row, std::size_t k, float height) {
    return !row.heights_m.empty() && row.heights_m[k] == height;
  };
  const int row = rows_ - 2;
  for (std::size_t k = 0; k < middle_.heights_m.size(); ++k) {
    const float height = middle_.heights_m[k];
    if (height == none_) continue;
    const bool is_constant = same(above_, k, height) || same(last_, k, height) ||
                             (k > 0 && same(middle_, k - 1, height)) ||
                             (k + 1 < middle_.heights_m.size() && same(middle_, k + 1, height));
    middle_.is_constant[k] = is_constant ? 1 : 0;
    if (!is_constant) continue;
    const auto place = seen_.find(height);
    if (place == seen_.end() && seen_.size() >= kMostHeights) continue;
    Seen& seen = place == seen_.end() ? seen_[height] : place->second;
    if (seen.height.cells++ == 0) seen.height = {height, 1, row, static_cast<int>(k), 0.0, false};
  }
  for (int k = 0; k < columns_; ++k) {
    if (k > 0) look_at_step(middle_, k - 1, middle_, k, row, row);
    if (!above_.heights_m.empty()) look_at_step(above_, k, middle_, k, row - 1, row);
  }
}

void HeightCensus::look_at_step(const Row& one, int column, const Row& other, int other_column, int row,
                                int other_row) {
  const auto a = static_cast<std::size_t>(column), b = static_cast<std::size_t>(other_column);
  const float from = one.heights_m[a], to = other.heights_m[b];
  if (from == to || from == none_ || to == none_) return;
  if (one.is_constant[a] == 0 && other.is_constant[b] == 0) {
    ++steps_;
    sum_of_steps_m_ += std::abs(static_cast<double>(to) - from);
    return;
  }
  look_at_edge(one, column, to, row);
  look_at_edge(other, other_column, from, other_row);
}

void HeightCensus::look_at_edge(const Row& at, int column, float beside_m, int row) {
  const auto k = static_cast<std::size_t>(column);
  if (at.is_constant[k] == 0) return;
  const auto place = seen_.find(at.heights_m[k]);
  if (place == seen_.end()) return;
  Seen& seen = place->second;
  const double step = std::abs(static_cast<double>(beside_m) - at.heights_m[k]);
  const double usual = steps_ == 0 ? step : sum_of_steps_m_ / static_cast<double>(steps_);
  ++seen.edges;
  const bool is_steep =
      step > kCliffGrade * cell_m_ || (step > kUnusualGrade * cell_m_ && step > kTimesUsual * usual);
  if (is_steep && step > kTerraces * quantum_m_) ++seen.steep;
  if (step <= seen.height.step_m) return;
  seen.height.step_m = step;
  seen.height.row = row;
  seen.height.column = column;
}

bool HeightCensus::is_cliff(const Seen& seen) const {
  const bool is_large = static_cast<double>(seen.height.cells) > kLeastShare * static_cast<double>(heights_);
  return seen.height.cells >= kLeastCells && seen.edges >= kLeastEdges && 2 * seen.steep >= seen.edges &&
         (seen.height.step_m >= kLeastStep_m || is_large);
}

std::vector<ConstantHeight> HeightCensus::findings() {
  // A row without heights brings the last one into the middle.
  const std::vector<float> beyond(static_cast<std::size_t>(columns_), none_);
  add_row(beyond.data(), none_);
  std::vector<ConstantHeight> found;
  if (is_flat_) return found;
  for (auto& [height, seen] : seen_) {
    seen.height.is_cliff = is_cliff(seen);
    if (seen.height.is_cliff ||
        static_cast<double>(seen.height.cells) > kLargeShare * static_cast<double>(heights_))
      found.push_back(seen.height);
  }
  std::sort(found.begin(), found.end(), [](const ConstantHeight& a, const ConstantHeight& b) {
    return std::pair(-a.cells, a.height_m) < std::pair(-b.cells, b.height_m);
  });
  found.resize(std::min(found.size(), kMostFindings));
  return found;
}

}  // namespace slipway::dem
