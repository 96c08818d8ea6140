#include "sim/single_wheel/wheel_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "core/random.h"
#include "sim/effects/effect_catalogue.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

WheelRigConditions test_on(const Soil& soil) {
  WheelRigConditions test;
  test.wheel = {0.125, 0.16};
  test.soil = soil;
  test.load_n = 108.0;
  test.drive = DriveMotor{};
  return test;
}

WheelSweep sweep_of(std::vector<SweepAxis> axes) {
  WheelSweep sweep;
  sweep.rig.rover = six_wheeler();
  sweep.rig.soil = sandy_loam();
  sweep.axes = std::move(axes);
  return sweep;
}

TEST(RigMotion, IsWhatARigThatTravelsAtAFixedSpeedDoes) {
  const double travel = 0.010;
  for (const double rim : {0.003, 0.0075, 0.010, 0.020, 0.100}) {
    for (const double beta_deg : {0.0, 15.0, 45.0, 90.0, -30.0}) {
      const double slip = (rim - travel) / std::max(travel, rim), beta = rad_from_deg(beta_deg);
      const WheelMotion motion = rig_motion(slip, beta);
      EXPECT_NEAR(motion.forward, travel * std::cos(beta) / rim, 1e-12);
      EXPECT_NEAR(motion.leftward, travel * std::sin(beta) / rim, 1e-12);
    }
  }
}

TEST(RigMotion, AgreesWithForwardMotionStraightAheadOnly) {
  const WheelMotion rig = rig_motion(0.3, 0.0), forward = forward_motion(0.3, 0.0);
  EXPECT_DOUBLE_EQ(rig.forward, forward.forward);
  EXPECT_DOUBLE_EQ(forward_motion(0.3, rad_from_deg(40.0)).forward, 0.7);
  EXPECT_LT(rig_motion(0.3, rad_from_deg(40.0)).forward, 0.6);
  EXPECT_NEAR(forward_motion(0.3, rad_from_deg(45.0)).leftward, 0.7, 1e-15);
}

TEST(RigMotion, ALockedWheelHasTheForcesOfTheLimit) {
  WheelRigConditions test = test_on(sandy_loam());
  test.sinkage_m = 0.02;
  test.slip = -1.0;
  const WheelRigResult locked = run_wheel_rig(test);
  test.slip = -1.0 + 1e-6;
  const WheelRigResult nearly = run_wheel_rig(test);
  EXPECT_NEAR(locked.forces.drawbar_pull_n, nearly.forces.drawbar_pull_n,
              1e-5 * std::abs(nearly.forces.drawbar_pull_n));
  test.slip = -1.0;
  EXPECT_EQ(rim_speed_m_s(test), 0.0);
}

TEST(WheelRigConditions, ABalancedWheelCarriesItsLoad) {
  for (const double slip : {-0.5, 0.0, 0.3, 0.9}) {
    for (const double beta_deg : {0.0, 20.0}) {
      WheelRigConditions test = test_on(sandy_loam());
      test.slip = slip;
      test.slip_angle_rad = rad_from_deg(beta_deg);
      const WheelRigResult result = run_wheel_rig(test);
      ASSERT_EQ(result.outcome, RigOutcome::kBalanced);
      EXPECT_NEAR(result.forces.vertical_n, 108.0, 1e-6);
    }
  }
}

TEST(WheelRigConditions, AHeldWheelCarriesWhatTheSameSinkageBalances) {
  WheelRigConditions test = test_on(loose_sand());
  const WheelRigResult free = run_wheel_rig(test);
  test.sinkage_m = free.sinkage_m;
  const WheelRigResult held = run_wheel_rig(test);
  EXPECT_EQ(held.outcome, RigOutcome::kHeld);
  EXPECT_NEAR(held.forces.vertical_n, 108.0, 1e-6);
  EXPECT_NEAR(held.forces.drawbar_pull_n, free.forces.drawbar_pull_n, 1e-6);
}

TEST(WheelRigConditions, TooMuchLoadIsSunkToTheAxleWithReason) {
  WheelRigConditions test = test_on(loose_sand());
  test.load_n = 5e4;
  const WheelRigResult result = run_wheel_rig(test);
  EXPECT_EQ(result.outcome, RigOutcome::kSunkToAxle);
  EXPECT_NE(result.reason.find("sunk to the axle: the soil carries"), std::string::npos) << result.reason;
  EXPECT_FALSE(result.current_a);
}

TEST(WheelRigConditions, WhereTheSolverFindsNoBalanceItSaysSo) {
  WheelRigConditions test = test_on(sandy_loam());
  test.soil.pressure = {0.0, 1e11, 0.1};
  test.load_n = 0.5;
  const WheelRigResult result = run_wheel_rig(test);
  EXPECT_EQ(result.outcome, RigOutcome::kNotBalanced);
  EXPECT_TRUE(result.reason.starts_with("not balanced: ")) << result.reason;
}

TEST(WheelRigConditions, ThrustLessResistanceIsThePull) {
  WheelRigConditions test = test_on(loose_sand());
  test.soil.bulldozing = 1.0;
  test.wheel.grousers = {0.01, 24.0};
  test.slip = 0.3;
  const WheelRigResult r = run_wheel_rig(test);
  EXPECT_GT(r.bulldozing_resistance_n, 1.0);
  EXPECT_GT(r.compaction_resistance_n, 1.0);
  EXPECT_NEAR(r.thrust_n - r.compaction_resistance_n - r.bulldozing_resistance_n, r.forces.drawbar_pull_n,
              1e-9);
  // The compaction resistance by its own integral, b r int(sigma sin theta).
  const Soil& s = test.soil;
  const double theta_m = (s.c1 + s.c2 * 0.3) * r.entry_angle_rad, k = s.pressure.stiffness(0.16);
  double sum = 0.0;
  const int n = 200'000;
  for (int i = 0; i < n; ++i) {
    const double theta = (i + 0.5) * r.entry_angle_rad / n;
    const double as =
        theta > theta_m ? theta : r.entry_angle_rad - theta / theta_m * (r.entry_angle_rad - theta_m);
    const double z = 0.125 * (std::cos(as) - std::cos(r.entry_angle_rad));
    sum += k * std::pow(z, s.pressure.n) * std::sin(theta) * r.entry_angle_rad / n;
  }
  EXPECT_NEAR(r.compaction_resistance_n, 0.16 * 0.125 * sum, 1e-3);
}

TEST(WheelRigConditions, EfficiencyIsUsefulOverDrivingPowerAndBelowOne) {
  WheelRigConditions test = test_on(sandy_loam());
  test.slip = 0.2;
  const WheelRigResult r = run_wheel_rig(test);
  ASSERT_TRUE(r.tractive_efficiency);
  EXPECT_NEAR(*r.tractive_efficiency, r.forces.drawbar_pull_n * 0.8 * 0.125 / r.forces.torque_nm, 1e-12);
  EXPECT_GT(*r.tractive_efficiency, 0.0);
  EXPECT_LT(*r.tractive_efficiency, 0.8);
  test.slip = -0.3;
  EXPECT_FALSE(run_wheel_rig(test).tractive_efficiency) << "a braked wheel has none";
}

TEST(WheelRigConditions, DrawnSidewaysItIsHeldBackFromEitherSideAlike) {
  WheelRigConditions test = test_on(sandy_loam());
  test.slip_definition = SlipDefinition::kTravel;
  test.slip_angle_rad = rad_from_deg(90.0);
  const WheelRigResult left = run_wheel_rig(test);
  test.slip_angle_rad = rad_from_deg(-90.0);
  const WheelRigResult right = run_wheel_rig(test);
  EXPECT_LT(left.forces.lateral_n, -10.0) << "against the motion to the left";
  EXPECT_NEAR(left.forces.lateral_n, -right.forces.lateral_n, 1e-9);
  EXPECT_NEAR(left.forces.drawbar_pull_n, right.forces.drawbar_pull_n, 1e-9);
}

// With independent shear the rim's thrust stays however fast the wheel is dragged sideways; with one
// resultant the dragging takes it all.
TEST(WheelRigConditions, ALockedWheelDraggedSidewaysHasNoThrustWhereShearIsCoupled) {
  WheelRigConditions test = test_on(sandy_loam());
  test.slip_definition = SlipDefinition::kTravel;
  test.slip_angle_rad = rad_from_deg(90.0);
  test.slip = -1.0;
  EXPECT_GT(run_wheel_rig(test).thrust_n, 20.0);
  test.soil.shear_coupling = 1.0;
  const WheelRigResult coupled = run_wheel_rig(test);
  EXPECT_NEAR(coupled.thrust_n, 0.0, 1e-3);
  EXPECT_LT(coupled.forces.lateral_n, -20.0);
}

TEST(WheelRigConditions, ASecondPassSinksLess) {
  WheelRigConditions test = test_on(loose_sand());
  test.soil.multipass_stiffening = 0.9;
  const double first = run_wheel_rig(test).sinkage_m;
  test.in_a_track = true;
  EXPECT_LT(run_wheel_rig(test).sinkage_m, 0.8 * first);
}

TEST(WheelRigConditions, TheHeldSpeedSetsTheRimSpeed) {
  WheelRigConditions test;
  test.slip = 0.5;
  test.speed_m_s = 0.01;
  EXPECT_DOUBLE_EQ(rim_speed_m_s(test), 0.01);
  test.speed_is_of_travel = true;
  EXPECT_DOUBLE_EQ(rim_speed_m_s(test), 0.02);
}

// A wheel under the weight W on a slope alpha carries W cos(alpha) and pulls W sin(alpha), at the smallest
// slip that does.
TEST(WheelRigConditions, OnASlopeTheSlipIsWhereThePullIsTheWeightsPartAlongIt) {
  WheelRigConditions test = test_on(sandy_loam());
  double last = -1.0;
  for (const double slope_deg : {-10.0, 0.0, 8.0, 14.0}) {
    test.slope_rad = rad_from_deg(slope_deg);
    const WheelRigResult result = run_wheel_rig(test);
    ASSERT_EQ(result.outcome, RigOutcome::kBalanced) << slope_deg;
    EXPECT_NEAR(result.forces.drawbar_pull_n, test.load_n * std::sin(*test.slope_rad), 1e-6 * test.load_n);
    EXPECT_NEAR(result.forces.vertical_n, test.load_n * std::cos(*test.slope_rad), 1e-5 * test.load_n);
    EXPECT_GT(result.slip, last);
    last = result.slip;
  }
  test.slope_rad = rad_from_deg(45.0);
  const WheelRigResult stuck = run_wheel_rig(test);
  EXPECT_EQ(stuck.outcome, RigOutcome::kImmobilised);
  EXPECT_FALSE(stuck.stands());
  EXPECT_NE(stuck.reason.find("at most"), std::string::npos);
}

TEST(WheelRigConditions, SlipByTheTipsIsLessTravelPerTurnOfTheRim) {
  WheelRigConditions test = test_on(sandy_loam());
  test.wheel.grousers = {.height_m = 0.01, .count = 24.0, .shear_share = 0.5};
  test.slip = 0.2;
  EXPECT_NEAR(motion_of(test).forward, 0.8, 1e-12);
  test.slip_radius = SlipRadius::kTip;
  EXPECT_NEAR(motion_of(test).forward, 0.8 * 0.135 / 0.125, 1e-12);
  test.slip_radius = SlipRadius::kShear;
  EXPECT_NEAR(motion_of(test).forward, 0.8 * 0.130 / 0.125, 1e-12);
}

TEST(WheelSweep, PairedRowsStandAtTheirOwnConditions) {
  WheelSweep sweep = sweep_of(
      {{"slip", {0.1, 0.4, 0.2}}, {"slip_angle_deg", {0.0, 10.0, 20.0}}, {"load_n", {80.0, 100.0, 120.0}}});
  EXPECT_FALSE(faults_of(sweep).empty());  // three axes are too many where every combination is made
  sweep.paired = true;
  ASSERT_TRUE(faults_of(sweep).empty());
  const std::vector<SweepRow> rows = run_wheel_sweep(sweep);
  ASSERT_EQ(rows.size(), 3U);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_EQ(rows[k].point.test.slip, sweep.axes[0].values[k]);
    EXPECT_EQ(rows[k].point.test.load_n, sweep.axes[2].values[k]);
    WheelSweep one = sweep_of({{"slip", {sweep.axes[0].values[k]}}});
    for (const std::size_t axis : {1U, 2U})
      one.set.push_back({sweep.axes[axis].parameter, sweep.axes[axis].values[k]});
    EXPECT_EQ(run_wheel_sweep(one).front().result.forces.drawbar_pull_n,
              rows[k].result.forces.drawbar_pull_n);
  }
  sweep.axes[1].values.pop_back();
  const std::vector<Fault> faults = faults_of(sweep);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].pointer, "/sweep/1/values");
}

TEST(Stepped, ReachesBothEndsWithoutRoundingErrors) {
  EXPECT_EQ(stepped(-0.2, 0.3, 0.1), (std::vector<double>{-0.2, -0.1, 0.0, 0.1, 0.2, 0.3}));
  EXPECT_EQ(stepped(0.7, 1.4, 0.1).size(), 8U);
  EXPECT_EQ(stepped(0.0, 1.0, 0.3), (std::vector<double>{0.0, 0.3, 0.6, 0.9}));
  EXPECT_EQ(stepped(2.0, 1.0, 0.3), (std::vector<double>{2.0}));
}

TEST(WheelSweep, HasEveryCombinationFirstAxisSlowest) {
  const auto rows = run_wheel_sweep(sweep_of({{"load_n", {50.0, 100.0}}, {"slip", {0.0, 0.1, 0.2}}}));
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_EQ(rows[1].point.at, (std::vector<double>{50.0, 0.1}));
  EXPECT_EQ(rows[3].point.at, (std::vector<double>{100.0, 0.0}));
  EXPECT_EQ(rows[3].point.test.load_n, 100.0);
  EXPECT_LT(rows[0].result.sinkage_m, rows[3].result.sinkage_m);
}

TEST(WheelSweep, EffectsSoilAndWheelCanBeSwept) {
  const auto grousers =
      run_wheel_sweep(sweep_of({{"effects.grousers.height_m", {0.0, 0.02}}, {"slip", {0.4}}}));
  EXPECT_GT(grousers[1].result.forces.drawbar_pull_n, grousers[0].result.forces.drawbar_pull_n + 1.0);
  const auto n = run_wheel_sweep(sweep_of({{"soil.n", {0.7, 1.4}}}));
  EXPECT_LT(n[0].result.sinkage_m, n[1].result.sinkage_m);
  const auto width = run_wheel_sweep(sweep_of({{"wheel.width_m", {0.1, 0.3}}}));
  EXPECT_GT(width[0].result.sinkage_m, width[1].result.sinkage_m);
  const auto slope = run_wheel_sweep(sweep_of({{"effects.slip_sinkage.n1", {0.0, 0.5}}, {"slip", {0.8}}}));
  EXPECT_GT(slope[1].result.sinkage_m, slope[0].result.sinkage_m);
}

TEST(WheelSweep, SetValuesHoldInEveryRowAndTheSweepStartsFromThem) {
  WheelSweep sweep = sweep_of({{"slip", {0.1, 0.5}}});
  sweep.set = {{"soil.n", 1.3}, {"soil.k_phi", 2e6}, {"effects.grousers.height_m", 0.02}};
  WheelSweep swept = sweep_of({{"slip", {0.1, 0.5}}});
  swept.rig.soil.pressure.n = 1.3;
  swept.rig.soil.pressure.k_phi = 2e6;
  swept.rig.effects = {{"grousers", {{"height_m", 0.02}}}};
  const auto a = run_wheel_sweep(sweep), b = run_wheel_sweep(swept);
  for (std::size_t k = 0; k < a.size(); ++k)
    EXPECT_EQ(a[k].result.forces.drawbar_pull_n, b[k].result.forces.drawbar_pull_n) << k;
  sweep.set = {{"soil.m", 1.0}, {"soil.n", 9.0}};
  const std::vector<Fault> faults = faults_of(sweep);
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_EQ(faults[0].pointer, "/set/soil.m");
  EXPECT_EQ(faults[1].pointer, "/set/soil.n");
  EXPECT_NE(faults[1].message.find("must be in ["), std::string::npos);
}

TEST(WheelSweep, EveryParameterThatIsKnownRunsAtTheEndsOfItsRange) {
  for (const std::string& name : sweep_field_names()) {
    const Field field = *sweep_field(name);
    if (name == "sinkage_m" || name == "slip_angle_deg" || name == "soil.k_c" || name == "soil.k_phi")
      continue;
    // Parameters of a law, "soil.LAW.PARAMETER", exist on soils that name the law alone.
    if (std::count(name.begin(), name.end(), '.') > 1) continue;
    const WheelSweep sweep = sweep_of({{name, {field.lowest, field.highest}}});
    EXPECT_EQ(faults_of(sweep), std::vector<Fault>{}) << name;
    for (const SweepRow& row : run_wheel_sweep(sweep)) {
      if (!row.result.stands()) {
        EXPECT_FALSE(row.result.reason.empty()) << name;
        continue;
      }
      const WheelForces& f = row.result.forces;
      for (const double value :
           {f.drawbar_pull_n, f.lateral_n, f.vertical_n, f.torque_nm, row.result.thrust_n,
            row.result.sinkage_m, row.result.current_a.value_or(0.0)})
        EXPECT_TRUE(std::isfinite(value)) << name << " = " << row.point.at[0];
    }
  }
}

TEST(WheelSweep, AnyCombinationGivesFiniteNumbersOrAReason) {
  const std::vector<std::string> names = sweep_field_names();
  int stood = 0;
  for (std::uint64_t trial = 0; trial < 3000; ++trial) {
    const std::uint64_t key = random_key(7, trial);
    WheelRig rig = sweep_of({}).rig;
    if (random_uniform(key, 0) < 0.5) rig.test.slip_definition = SlipDefinition::kTravel;
    for (std::size_t k = 0; k < names.size(); ++k) {
      const double chance = random_uniform(key, 2 * k + 1), share = random_uniform(key, 2 * k + 2);
      if (chance > 0.2 || names[k] == "sinkage_m" || names[k] == "soil.k_c" || names[k] == "soil.k_phi")
        continue;
      const Field field = *sweep_field(names[k]);
      double value = field.lowest + share * (field.highest - field.lowest);
      if (chance < 0.04) value = share < 0.5 ? field.lowest : field.highest;
      if (names[k] == "slip_angle_deg" && rig.test.slip_definition == SlipDefinition::kForward) value *= 0.99;
      set_sweep_parameter(names[k], value, rig);
    }
    const WheelRigConditions test = conditions_of(rig);
    const WheelRigResult r = run_wheel_rig(test);
    if (!r.stands()) {
      EXPECT_FALSE(r.reason.empty());
      continue;
    }
    ++stood;
    const double load = test.load_n * std::cos(test.slope_rad.value_or(0.0));
    EXPECT_NEAR(r.forces.vertical_n, load, 1e-6 * load);
    for (const double value : {r.forces.drawbar_pull_n, r.forces.lateral_n, r.forces.torque_nm, r.thrust_n,
                               r.compaction_resistance_n, r.bulldozing_resistance_n, r.sinkage_m,
                               r.current_a.value_or(0.0), r.tractive_efficiency.value_or(0.0)})
      EXPECT_TRUE(std::isfinite(value)) << trial;
  }
  EXPECT_GT(stood, 1500);
}

TEST(WheelSweep, ARoversOwnEffectsActAndCanBeSwept) {
  WheelSweep sweep = sweep_of({{"effects.grousers.count", {24.0}}});
  sweep.rig.rover.effects = {{.name = "grousers", .parameters = {{"height_m", 0.03}}}};
  EXPECT_EQ(points_of(sweep)[0].test.wheel.grousers.height_m, 0.03);
  sweep.rig.effects = {{.name = "grousers", .parameters = {}, .on = false}};
  sweep.axes = {{"slip", {0.0}}};
  EXPECT_EQ(points_of(sweep)[0].test.wheel.grousers.height_m, 0.0);
}

TEST(WheelSweep, EffectsThatDoNotActOnOneWheelAreKnown) {
  std::vector<std::string> without;
  for (const Effect& effect : effect_catalogue())
    if (!acts_on_single_wheel(effect.name)) without.emplace_back(effect.name);
  EXPECT_EQ(without, (std::vector<std::string>{"com_offset", "dragging_wheel", "soft_patch",
                                               "steering_offset", "attitude_bias"}));
}

std::vector<std::string> pointers_of(const std::vector<Fault>& faults) {
  std::vector<std::string> pointers;
  for (const Fault& fault : faults) pointers.push_back(fault.pointer);
  return pointers;
}

TEST(WheelSweep, FaultsNameTheAxisAndTheValue) {
  EXPECT_EQ(pointers_of(faults_of(sweep_of({{"slipp", {0.0}}, {"soil.n", {1.0, 9.0}}}))),
            (std::vector<std::string>{"/sweep/0/parameter", "/sweep/1/values/1"}));
  EXPECT_EQ(pointers_of(faults_of(sweep_of({{"effects.com_offset.x_m", {0.0}}}))),
            (std::vector<std::string>{"/sweep/0/parameter"}));
  EXPECT_EQ(pointers_of(faults_of(sweep_of({{"slip", {0.1}}, {"slip", {0.2}}}))),
            (std::vector<std::string>{"/sweep/1/parameter"}));
  const std::vector<double> many(101, 0.5);
  EXPECT_EQ(pointers_of(faults_of(sweep_of({{"slip", many}, {"load_n", many}}))),
            (std::vector<std::string>{"/sweep"}));
  EXPECT_EQ(pointers_of(faults_of(sweep_of({{"slip_angle_deg", {0.0, 90.0}}}))),
            (std::vector<std::string>{"/sweep/0"}));
  EXPECT_EQ(pointers_of(faults_of(sweep_of({{"sinkage_m", {0.2}}}))), (std::vector<std::string>{"/sweep/0"}));
  EXPECT_EQ(pointers_of(faults_of(sweep_of({{"soil.k_phi", {-1e6}}}))), (std::vector<std::string>{"/soil"}));
}

}  // namespace
}  // namespace slipway::sim
