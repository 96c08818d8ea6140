#include "planner/judge/plan_scout.h"

#include <algorithm>
#include <array>

#include "sim/prediction/scout_drive.h"

namespace slipway::planner {
namespace {

// Of one measured slip: its weight, and the weighted cost of each route.
struct Measured {
  double weight = 0.0;
  std::vector<double> costs;
};

std::size_t cheapest(const std::vector<double>& costs) {
  return static_cast<std::size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
}

}  // namespace

std::optional<PlanScout> scout_of(const std::vector<Route>& routes) {
  if (routes.empty() || !routes.front().prediction.scout) return std::nullopt;
  const sim::ScoutDrive& scout = *routes.front().prediction.scout;
  std::vector<const Route*> choice;
  std::size_t draws = scout.drawn_slip.size();
  for (const Route& route : routes) {
    if (route.prediction.immobilised) continue;
    choice.push_back(&route);
    draws = std::min(draws, route.drawn_costs.size());
  }
  if (choice.empty() || draws == 0) return std::nullopt;
  Measured before{0.0, std::vector<double>(choice.size(), 0.0)};
  std::array<Measured, sim::kSlipBins> after;
  after.fill(before);
  for (std::size_t d = 0; d < draws; ++d) {
    const double weight = choice.front()->drawn_costs[d].weight;
    const auto shares =
        sim::measured_shares(scout.drawn_slip[d], scout.slip_error, scout.to_m - scout.from_m);
    before.weight += weight;
    for (std::size_t r = 0; r < choice.size(); ++r) {
      const double cost = weight * choice[r]->drawn_costs[d].cost;
      before.costs[r] += cost;
      for (std::size_t bin = 0; bin < shares.size(); ++bin) after[bin].costs[r] += shares[bin] * cost;
    }
    for (std::size_t bin = 0; bin < shares.size(); ++bin) after[bin].weight += shares[bin] * weight;
  }
  if (before.weight <= 0.0) return std::nullopt;
  PlanScout out{.route = routes.front().rank, .worth = before.costs[cheapest(before.costs)]};
  for (const Measured& measured : after) {
    const std::size_t best = cheapest(measured.costs);
    out.worth -= measured.costs[best];
    if (best != cheapest(before.costs)) out.other_route += measured.weight;
  }
  out.worth = std::max(0.0, out.worth / before.weight);
  out.other_route /= before.weight;
  return out;
}

}  // namespace slipway::planner
