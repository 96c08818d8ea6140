#include "sim/prediction/conditioned_draw.h"

#include <utility>
#include <vector>

#include "core/random.h"

namespace slipway::sim {
namespace {

// Cells of the drive on which no earlier drive has been get another key for each try but the first.
RedrawnCells redraw(const ConditionedDraw& draw, const std::unordered_set<std::uint64_t>& met, int tried) {
  RedrawnCells redrawn = draw.redrawn;
  for (const std::uint64_t cell : met)
    if (!draw.met.contains(cell)) redrawn[cell] = random_key(cell, static_cast<std::uint64_t>(tried));
  return redrawn;
}

bool is_all_known(const ConditionedDraw& draw, const std::unordered_set<std::uint64_t>& met) {
  for (const std::uint64_t cell : met)
    if (!draw.met.contains(cell)) return false;
  return true;
}

}  // namespace

void condition(const DrawnDriver& driver, std::uint64_t key, const PastDriveReport& report,
               const Progress& progress, ConditionedDraw& draw) {
  std::unordered_set<std::uint64_t> met;
  const auto likelihood = [&](const RedrawnCells& redrawn, std::unordered_set<std::uint64_t>* noted) {
    const DrawnRun how{.to_first_stop = true, .redrawn = &redrawn, .met = noted};
    const DriveOutcome outcome = driver.run(key, how, progress).outcome;
    const bool stops = outcome.stops > 0 || outcome.embedded;
    return stops == report.stopped ? 1.0 - report.model_error : report.model_error;
  };
  double sum = likelihood(draw.redrawn, &met);
  int tries = 1;
  if (!is_all_known(draw, met)) {
    RedrawnCells kept = draw.redrawn;
    const std::uint64_t coin = random_key(key, met.size() + draw.met.size());
    for (; tries < report.tries && !progress.cancelled(); ++tries) {
      RedrawnCells tried = redraw(draw, met, tries);
      const double here = likelihood(tried, nullptr);
      sum += here;
      // Each try is kept with its share of the likelihood so far, so that in the end each had its own.
      if (random_uniform(coin, static_cast<std::uint64_t>(tries)) < here / sum) kept = std::move(tried);
    }
    draw.redrawn = std::move(kept);
  }
  draw.weight *= sum / tries;
  draw.met.merge(met);
}

}  // namespace slipway::sim
