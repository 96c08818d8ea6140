#include "planner/judge/deciding_draws.h"

#include <algorithm>

#include "planner/problem/verdict.h"

namespace slipway::planner {
namespace {

constexpr int kFirstLongDraws = 16;
// Stations times draws of one drive: one of 5 km gets 30 draws, one of 12 km the first alone. What these do
// not decide they leave open.
constexpr double kMaxStationDraws = 300'000.0;

}  // namespace

sim::RiskOptions risk_of_drive(const sim::RiskOptions& asked, double length_m, std::size_t stations) {
  sim::RiskOptions risk = asked;
  if (length_m < kLongDrive_m) return risk;
  if (risk.segment_m <= 0.0) risk.segment_m = kSegment_m;
  if (risk.max_draws <= risk.draws) return risk;
  risk.draws = std::min(risk.draws, kFirstLongDraws);
  const int most = static_cast<int>(kMaxStationDraws / static_cast<double>(stations + 1));
  risk.max_draws = std::clamp(most, risk.draws, risk.max_draws);
  return risk;
}

}  // namespace slipway::planner
