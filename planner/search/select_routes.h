#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace slipway::planner {

// Two routes differ when neither shares more than this much of its length with the other within a rover's
// width.
constexpr double kMaxOverlap = 0.6;

// Which of some routes differ: neither shares more than kMaxOverlap of its length with the other.
class Differences {
 public:
  // width_m: the rover's.
  explicit Differences(double width_m) : width_m_(width_m) {}

  void add(std::vector<Eigen::Vector2d> centreline);
  std::size_t size() const { return lines_.size(); }
  // The larger of the two shares.
  double shared(std::size_t a, std::size_t b) const { return shared_[a][b]; }
  bool differ(std::size_t a, std::size_t b) const;

 private:
  double width_m_;
  std::vector<std::vector<Eigen::Vector2d>> lines_;
  std::vector<std::vector<double>> shared_;
};

// Costs whose draws do not tell them apart are tied where they differ by no more than this share. So no
// search is begun that could not gain more.
constexpr double kTiedShare = 0.03;

// A route that is dearer than the cheapest by no more than this share may stand first in its place, where
// more routes differ from it.
constexpr double kAsGoodAsBest = 0.01;

// How many costs, which rise, are as good as the first: at least one.
std::size_t as_good_as_best(const std::vector<double>& rising_costs);

// Of candidates in `order` (best first) a set that differs in pairs and has one of the first `leaders` in it:
// as many as can be had up to `wanted`, and among the sets of that size the one whose best is best, then
// whose second is best, and so on. Best first.
std::vector<std::size_t> select_routes(const Differences& differences, const std::vector<std::size_t>& order,
                                       std::size_t leaders, std::size_t wanted);

}  // namespace slipway::planner
