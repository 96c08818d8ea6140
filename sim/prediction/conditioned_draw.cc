#include "sim/prediction/conditioned_draw.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "core/random.h"
#include "sim/prediction/odometry_shortfall.h"

namespace slipway::sim {
namespace {

// Cells of the drive on which no earlier drive has been get another key for each try but the first.
RedrawnCells redraw(const ConditionedDraw& draw, const std::unordered_set<std::uint64_t>& met, int tried) {
  RedrawnCells redrawn = draw.redrawn;
  for (const std::uint64_t cell : met)
    if (!draw.met.contains(cell))
      redrawn.keys[cell] = random_key(draw.redrawn.key_of(cell), static_cast<std::uint64_t>(tried));
  return redrawn;
}

// The radius that odometry reckons with over the true one, mean of the wheels.
double reckoned_over_true(const RoverModel& rover) {
  double sum = 0.0;
  for (const WheelModel& wheel : rover.wheels) sum += wheel.reckoned_radius_m() / wheel.radius_m;
  return sum / static_cast<double>(rover.wheels.size());
}

bool is_all_known(const ConditionedDraw& draw, const std::unordered_set<std::uint64_t>& met) {
  for (const std::uint64_t cell : met)
    if (!draw.met.contains(cell)) return false;
  return true;
}

// likelihood(redrawn, noted): how likely the draw with these cells redrawn makes what was reported; `noted`
// gets the cells that it meets, where it is no null pointer.
template <class Likelihood>
void resample(std::uint64_t key, int most_tries, const Progress& progress, ConditionedDraw& draw,
              const Likelihood& likelihood) {
  std::unordered_set<std::uint64_t> met;
  double sum = likelihood(draw.redrawn, &met);
  int tries = 1;
  if (!is_all_known(draw, met)) {
    RedrawnCells kept = draw.redrawn;
    const std::uint64_t coin = random_key(key, met.size() + draw.met.size());
    for (; tries < most_tries && !progress.cancelled(); ++tries) {
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

}  // namespace

double effective_draws(const std::vector<ConditionedDraw>& draws) {
  double sum = 0.0, squares = 0.0;
  for (const ConditionedDraw& draw : draws) {
    sum += draw.weight;
    squares += draw.weight * draw.weight;
  }
  return squares > 0.0 ? sum * sum / squares : 0.0;
}

std::vector<ConditionedDraw> renewed(const std::vector<ConditionedDraw>& draws, std::size_t count,
                                     std::uint64_t key) {
  double sum = 0.0;
  for (const ConditionedDraw& draw : draws) sum += draw.weight;
  std::vector<ConditionedDraw> out;
  double passed = 0.0;
  std::size_t from = 0;
  const double first = random_uniform(key, 0);
  for (std::size_t k = 0; k < count; ++k) {
    const double wanted = sum * (static_cast<double>(k) + first) / static_cast<double>(count);
    while (from + 1 < draws.size() && passed + draws[from].weight < wanted) passed += draws[from++].weight;
    ConditionedDraw& copy = out.emplace_back(draws[from]);
    copy.number = draws[from].number.value_or(from);
    copy.weight = 1.0;
    for (const std::uint64_t cell : copy.met)
      copy.redrawn.keys.try_emplace(cell, draws[from].redrawn.key_of(cell));
    copy.redrawn.renewal = random_bits(key, k + 1) >> 33U;
  }
  // In an order in which the first of them are as good as any [Fisher & Yates].
  for (std::size_t k = out.size(); k > 1; --k)
    std::swap(out[k - 1], out[random_bits(random_key(key, 1), k) % k]);
  return out;
}

void condition(const DrawnDriver& driver, std::uint64_t key, const PastDriveReport& report,
               const Progress& progress, ConditionedDraw& draw) {
  resample(key, report.tries, progress, draw,
           [&](const RedrawnCells& redrawn, std::unordered_set<std::uint64_t>* noted) {
             const DrawnRun how{.to_first_stop = true, .redrawn = &redrawn, .met = noted};
             const DriveOutcome outcome = driver.run(key, how, progress).outcome;
             const bool stops = outcome.stops > 0 || outcome.embedded;
             return stops == report.stopped ? 1.0 - report.model_error : report.model_error;
           });
}

StretchDriver::StretchDriver(const RoverModel& rover, double gravity_m_s2, const SoilBeliefs& beliefs,
                             const PreparedDrive& drive)
    : rover_(rover),
      gravity_m_s2_(gravity_m_s2),
      beliefs_(beliefs),
      drive_(drive),
      drives_level_(rover, gravity_m_s2) {}

DrawnStretch StretchDriver::run(std::uint64_t key, const RedrawnCells& redrawn,
                                std::unordered_set<std::uint64_t>* met) const {
  DrawnGround ground(beliefs_, key, std::cref(drives_level_), &redrawn);
  if (met) ground.note(*met);
  QuasiStaticSolver solver(rover_, gravity_m_s2_, Precision::kDraws);
  PerWheel<Soil> under(rover_.wheels.size());
  DrawnStretch out;
  std::vector<double> currents(rover_.wheels.size(), 0.0);
  double rolled_m = 0.0, come_m = 0.0, last_slip = 0.0;
  int with_current = 0;
  for (const PreparedStation& station : drive_.stations) {
    for (std::size_t k = 0; k < under.size(); ++k) {
      under[k] = ground.at(station.soil[k], station.pose.x_m, station.pose.y_m);
      out.slip_error += unresolved_slip_error(beliefs_.of(station.soil[k])) /
                        static_cast<double>(under.size() * drive_.stations.size());
    }
    StationState state = solver.solve(station.stance, under, station.command);
    scale_slip(slip_scale(ground, station), state);
    last_slip = state.moving() ? std::min(state.slip_ratio, 1.0) : 1.0;
    // As odometry counts it, by the radius that it reckons with.
    come_m += station.drive_m;
    rolled_m += station.drive_m * roll_per_way(last_slip) * reckoned_over_true(rover_);
    if (state.by_slip_curve) continue;
    ++with_current;
    for (std::size_t k = 0; k < currents.size(); ++k) currents[k] += std::abs(state.wheels[k].current_a);
  }
  out.slip_ratio = rolled_m > 0.0 ? 1.0 - come_m / rolled_m : last_slip;
  if (with_current == 0) return out;
  for (double& current : currents) current /= with_current;
  out.currents_a = std::move(currents);
  return out;
}

double condition(const StretchDriver& driver, std::uint64_t key, const MeasuredStretch& measured,
                 const TelemetryErrors& errors, int tries, const Progress& progress, ConditionedDraw& draw) {
  std::optional<double> before;
  resample(key, tries, progress, draw,
           [&](const RedrawnCells& redrawn, std::unordered_set<std::uint64_t>* noted) {
             const DrawnStretch drawn = driver.run(key, redrawn, noted);
             if (!before) before = drawn.slip_ratio;
             return likelihood(measured, drawn, errors);
           });
  return *before;
}

}  // namespace slipway::sim
