#include "sim/prediction/closure_reach.h"

#include <array>
#include <cmath>

#include "core/normal_interval.h"
#include "core/parallel_for.h"

namespace slipway::sim {
namespace {

// What c1 and c2 differ by between soils, as wheel tests of four have it: slipway estimate belief
// data/beliefs/wheel_tests_closures.json, "one not tested".
constexpr double kC1BetweenSoils = 0.22, kC2BetweenSoils = 0.20, kCorrelationBetweenSoils = 0.15;

bool has_closures(const SoilDistribution& soil) {
  return soil.mean.slip_curve == nullptr && (soil.mean.c1 > 0.0 || soil.mean.c2 > 0.0);
}

// c1 and c2 alone with their spread: the soil's own or, where its file gives none, that between soils.
SoilDistribution closures_of(const SoilDistribution& belief) {
  SoilDistribution closures;
  closures.mean.c1 = belief.mean.c1;
  closures.mean.c2 = belief.mean.c2;
  const bool own = belief.std.c1 > 0.0 || belief.std.c2 > 0.0;
  closures.std.c1 = own ? belief.std.c1 : kC1BetweenSoils;
  closures.std.c2 = own ? belief.std.c2 : kC2BetweenSoils;
  closures.closure_correlation = own ? belief.closure_correlation : kCorrelationBetweenSoils;
  return closures;
}

// The mean soil with the c1 and c2 that lie `deviations` along the direction in which c1 + c2 / 2 grows most.
Soil at_end(const SoilDistribution& belief, double deviations) {
  Soil soil = belief.mean;
  if (!has_closures(belief)) return soil;
  constexpr double kStep = 1e-3, kSlip = 0.5;
  const SoilDistribution closures = closures_of(belief);
  const auto share = [&](const ClosureNormals& z) {
    const Soil drawn = draw_soil(closures, SoilNormals::Zero(), z);
    return drawn.c1 + kSlip * drawn.c2;
  };
  ClosureNormals direction;
  for (int k = 0; k < kClosureDims; ++k)
    direction[k] = share(kStep * ClosureNormals::Unit(k)) - share(-kStep * ClosureNormals::Unit(k));
  if (!(direction.norm() > 0.0)) return soil;
  const Soil drawn = draw_soil(closures, SoilNormals::Zero(), deviations * direction.normalized());
  soil.c1 = drawn.c1;
  soil.c2 = drawn.c2;
  return soil;
}

// The soils of all ground at one end.
struct EndSoils {
  std::vector<Soil> known;
  Soil unknown;

  EndSoils(const SoilBeliefs& beliefs, double deviations) : unknown(at_end(beliefs.unknown, deviations)) {
    for (const SoilDistribution& belief : beliefs.known) known.push_back(at_end(belief, deviations));
  }
  const Soil& of(std::optional<std::size_t> soil) const { return soil ? known[*soil] : unknown; }
};

// Unknown ground where any wheel is on it.
std::optional<std::size_t> ground_under(const PreparedStation& station) {
  for (std::size_t k = 0; k < station.soil.size(); ++k)
    if (!station.soil[k]) return std::nullopt;
  return station.soil[0];
}

ClosureEnd drive_on(const EndSoils& soils, const RoverModel& rover, double gravity_m_s2,
                    const PreparedDrive& drive, const DriveLimits& limits, const Progress& progress) {
  ClosureEnd end;
  QuasiStaticSolver solver(rover, gravity_m_s2, Precision::kDraws);
  const StationRules rules(rover, limits);
  PerWheel<Soil> under(rover.wheels.size());
  for (const PreparedStation& station : drive.stations) {
    if (progress.cancelled()) break;
    for (std::size_t k = 0; k < under.size(); ++k) under[k] = soils.of(station.soil[k]);
    const StationState state = solver.solve(station.stance, under, station.command);
    const auto ground = ground_under(station);
    if (std::abs(state.slip_ratio) > end.max_slip_ratio || !state.moving()) {
      end.max_slip_ratio = std::abs(state.slip_ratio);
      end.soil = ground;
      end.c1 = soils.of(ground).c1;
      end.c2 = soils.of(ground).c2;
    }
    end.breaks_a_limit = end.breaks_a_limit || rules.broken_by(station.stance, station.command, state, true);
    if (state.moving()) continue;
    end.immobilised_at_m = station.distance_m;
    break;
  }
  return end;
}

}  // namespace

std::optional<ClosureReach> closure_reach(const RoverModel& rover, double gravity_m_s2,
                                          const SoilBeliefs& beliefs, const PreparedDrive& drive,
                                          const DriveLimits& limits, std::size_t threads,
                                          const Progress& progress) {
  bool any = false;
  for (const PreparedStation& station : drive.stations) {
    for (std::size_t k = 0; k < station.soil.size() && !any; ++k)
      any = has_closures(beliefs.of(station.soil[k]));
    if (any) break;
  }
  if (!any) return std::nullopt;
  std::array<ClosureEnd, 2> ends;
  parallel_for(ends.size(), threads, [&](std::size_t k) {
    const EndSoils soils(beliefs, k == 0 ? -kReach90 : kReach90);
    ends[k] = drive_on(soils, rover, gravity_m_s2, drive, limits, progress);
  });
  return ClosureReach{ends[0], ends[1]};
}

}  // namespace slipway::sim
