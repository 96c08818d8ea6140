#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace slipway::planner {

enum class RankBy { kExpected, kCvar };

// "expected", "cvar".
std::string_view describe(RankBy by);

// By what figure of its drawn costs a route is ranked, and by what its search is guided.
struct Ranking {
  RankBy by = RankBy::kExpected;
  double tail = 0.1;  // share of the draws, the dearest, whose mean is the CVaR; in (0, 1]

  // 1 where routes are ranked by the mean.
  double ranked_tail() const { return by == RankBy::kCvar ? tail : 1.0; }
  // "in the mean of 272 draws", "in the mean of the worst 10 % of 272 draws".
  std::string in_words(int draws) const;
};

struct WeightedCost {
  double cost = 0.0;
  double weight = 1.0;
};

// The weights that the costs have in the mean of the dearest `tail` share of them; they add up to 1, and with
// a tail of 1 are the costs' own. The cost at the tail's edge counts by the part of its weight that lies in
// the tail [Rockafellar & Uryasev 2002, proposition 8].
std::vector<double> tail_weights(const std::vector<WeightedCost>& costs, double tail);

// Conditional value at risk: the mean of the dearest `tail` share of the costs [Rockafellar & Uryasev 2000].
// At least the mean, and the mean where the tail is 1. There must be a cost with a weight.
double conditional_value_at_risk(const std::vector<WeightedCost>& costs, double tail);

// The difference of two routes' ranked costs with its 90 % interval.
struct CostDifference {
  double value = 0.0, low = 0.0, high = 0.0;
  int draws = 0;  // that both routes have

  // Nought lies outside the interval.
  bool decided() const { return low > 0.0 || high < 0.0; }
};

// a's cost less b's over the draws that both have: draw by draw, since a draw is the same ground for both. Of
// the CVaR what is compared is each draw's share in Rockafellar & Uryasev's sum, VaR + max(0, cost - VaR) /
// tail, whose mean it is. The interval is Student's with as many draws as the tail effectively has. It knows
// only of what happened in the draws: an embedding that none of them met is in no interval.
CostDifference difference_of(const std::vector<WeightedCost>& a, const std::vector<WeightedCost>& b,
                             double tail);

}  // namespace slipway::planner
