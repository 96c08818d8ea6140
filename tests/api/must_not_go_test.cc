// Drives that cost a rover, or nearly did: whatever else the decision says of them, it is not GO.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "api/service.h"
#include "planner/judge/drive_verdict.h"
#include "sim/rover/wheel_failure.h"
#include "tests/sim/reference_models.h"

namespace slipway::api {
namespace {

using planner::Verdict;
using sim::FunctionGround;

const Catalogue& shipped() {
  static const auto service = Service::open({.data = SLIPWAY_DATA_FOLDER});
  return *(*service)->catalogue();
}

const sim::SoilDistribution& soil(const char* name) {
  return shipped().soils.at(name);
}

// The same soil with c1 and c2 drawn too, as data/beliefs/closures_drawn.json has them.
void draw_closures(sim::SoilDistribution& of) {
  of.std.c1 = 0.22;
  of.std.c2 = 0.20;
  of.closure_correlation = 0.15;
  for (sim::SoilAlternative& each : of.alternatives) {
    sim::SoilDistribution drawn = *each.soil;
    draw_closures(drawn);
    each.soil = std::make_shared<const sim::SoilDistribution>(std::move(drawn));
  }
}

struct Drive {
  sim::RoverModel rover = *shipped().rovers.at("mer-class");
  sim::SoilBeliefs beliefs{{soil("jlu_mars_2_medium")}, soil("unknown_ground")};
  sim::PathStation start;
  double length_m = 12.0;

  // Whatever the answer is on the soils as they are, c1 and c2 that are drawn too make no GO of it.
  Verdict decided(const sim::Ground& ground) const {
    Drive drawn = *this;
    for (sim::SoilDistribution& known : drawn.beliefs.known) draw_closures(known);
    draw_closures(drawn.beliefs.unknown);
    const Verdict as_shipped = decided_by_soils(ground);
    if (as_shipped != Verdict::kGo) {
      EXPECT_NE(drawn.decided_by_soils(ground), Verdict::kGo) << "with c1 and c2 drawn";
    }
    return as_shipped;
  }

  Verdict decided_by_soils(const sim::Ground& ground) const {
    std::vector<sim::PathStation> path;
    const double travel = start.pose.yaw_rad + (start.backwards ? std::numbers::pi : 0.0);
    for (int k = 0; k * 0.2 <= length_m; ++k) {
      sim::PathStation station = start;
      station.distance_m = 0.2 * k;
      station.pose.x_m += station.distance_m * std::cos(travel);
      station.pose.y_m += station.distance_m * std::sin(travel);
      path.push_back(station);
    }
    planner::PlanProblem problem;
    problem.beliefs = beliefs;
    const sim::RiskOptions risk{.draws = 32, .max_draws = 1000};
    NoProgress progress;
    const auto drive =
        sim::predict_drive(rover, 3.71, ground, beliefs, path, sim::DriveLimits{}, risk, 0, progress);
    EXPECT_TRUE(drive);
    return planner::judge_drive(problem, *drive).verdict;
  }
};

FunctionGround slope(double deg) {
  const double rise = std::tan(rad_from_deg(deg));
  return FunctionGround([rise](double x, double) { return rise * x; });
}

TEST(MustNotGo, ButLevelFirmGroundIsAGo) {
  EXPECT_EQ(Drive().decided(slope(0.0)), Verdict::kGo);
}

// Ground that no map names, 300 m of it and level, with checks of the slip every 5 m.
TEST(MustNotGo, ButLevelUnknownGroundHardlyEverEmbeds) {
  const sim::SoilBeliefs beliefs{{}, soil("unknown_ground")};
  std::vector<sim::PathStation> path;
  for (int k = 0; k <= 1200; ++k) path.push_back({.pose = {0.25 * k, 0.0, 0.0}, .distance_m = 0.25 * k});
  const FunctionGround level([](double, double) { return 0.0; }, 1e6,
                             [](double, double) { return std::optional<std::size_t>(); });
  NoProgress progress;
  const auto drive = sim::predict_drive(*shipped().rovers.at("mer-class"), 3.71, level, beliefs, path,
                                        sim::DriveLimits{}, {.draws = 272}, 0, progress);
  ASSERT_TRUE(drive);
  EXPECT_LT(drive->outcomes.embedding.share, 0.01);
}

// The drive of sol 2143, as data/campaigns/opportunity_sol_2143.json has it: backwards over a ripple 5 m wide
// and 0.5 m high; the rover slipped by up to 65 %.
TEST(MustNotGo, TheRippleOfOpportunitysSol2143) {
  Drive drive;
  sim::SoilDistribution sand = soil("mer_b_slope_soil");
  sand.name = "ripple_sand";
  sand.mean.pressure = {1400.0, 350000.0, 1.0};
  sand.mean.cohesion_pa = 900.0;
  sand.mean.friction_angle_rad = rad_from_deg(36.0);
  sand.mean.shear_modulus_x_m = sand.mean.shear_modulus_y_m = 0.02;
  sand.mean.c1 = 0.285;
  sand.mean.c2 = 0.1;
  sand.mean.n1 = 0.2;
  drive.beliefs.known = {sand};
  drive.start.pose = {-3.6, 0.0, std::numbers::pi};
  drive.start.backwards = true;
  const FunctionGround ripple([](double x, double) {
    return std::abs(x) < 2.5 ? 0.25 * (1.0 + std::cos(2.0 * std::numbers::pi * x / 5.0)) : 0.0;
  });
  EXPECT_NE(drive.decided(ripple), Verdict::kGo);
}

// As data/campaigns/spirit_dead_wheel.json has it: backwards up a slope of 8 deg, dragging a locked wheel;
// the rover slipped by about 90 %.
TEST(MustNotGo, SpiritUpASlopeWithADeadWheel) {
  Drive drive;
  drive.beliefs.known = {soil("vl2_crusty_cloddy")};
  sim::fail_wheels(drive.rover, {{"rf", sim::WheelFailure::kLocked}});
  drive.start.pose.yaw_rad = std::numbers::pi;
  drive.start.backwards = true;
  EXPECT_NE(drive.decided(slope(8.0)), Verdict::kGo);
}

// Troy: a crust that broke under the wheels, over sand on which a rover gets nowhere on the slope beside the
// crater's rim [Arvidson et al. 2010, J. Geophys. Res. 115, E00F03]. Even where the crust carries in 17 of 20
// patches, the other three are no GO.
TEST(MustNotGo, ACrustPatchOverLooseSand) {
  Drive drive;
  sim::SoilDistribution crusted = soil("mer_a_dense");
  const auto carries = std::make_shared<const sim::SoilDistribution>(soil("mer_a_dense"));
  const auto breaks = std::make_shared<const sim::SoilDistribution>(soil("mer_a_loose"));
  crusted.alternatives = {{"carries", carries, 0.85, 0.85}, {"breaks", breaks, 0.15, 0.15}};
  crusted.alternatives_by = sim::AlternativesBy::kPatch;
  crusted.correlation_length_m = 10.0;
  crusted.drawn_apart = false;
  drive.beliefs.known = {crusted};
  EXPECT_NE(drive.decided(slope(6.0)), Verdict::kGo);
}

}  // namespace
}  // namespace slipway::api
