#include "sim/wheel/wheel_closures.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "sim/effects/effect_catalogue.h"
#include "sim/soil/grouser_law.h"
#include "sim/soil/hyperbolic_shear.h"
#include "sim/wheel/entry_angle.h"
#include "sim/wheel/slip_ratio.h"
#include "sim/wheel/wheel_kernel.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

constexpr WheelGeometry kWheel{.radius_m = 0.058, .width_m = 0.05};

// Sand near that of the sandbox of [Pavlov & Johnson 2022].
Soil closed_sand() {
  Soil sand;
  sand.pressure = {0.0, 3e6, 1.338};
  sand.cohesion_pa = 10.0;
  sand.friction_angle_rad = 0.506;
  sand.shear_modulus_x_m = 0.0175;
  sand.shear_modulus_y_m = 0.0064;
  sand.density_kg_m3 = 1330.0;
  sand.gravity_m_s2 = 9.81;
  sand.c1 = sand.c2 = 0.0;
  sand.exit_angle_ratio = 0.43;
  sand.shear_law.row = &kHyperbolicShear;
  sand.slip_directed = 1.0;
  sand.inclined_softening = 2.1;
  sand.digging = {
      .rim_share = 0.17, .rim_slip = 0.6, .cleat_share = 0.5, .cleat_limit = 5.0, .sideways = 1.5};
  sand.ploughing = {.front = 8.0,
                    .wall = 12.0,
                    .heap = 1.7,
                    .heap_slip = 1.8,
                    .wall_friction = 0.4,
                    .wall_turn = 0.11,
                    .wall_yield = 0.84};
  return sand;
}

WheelGeometry cleated() {
  WheelGeometry wheel = kWheel;
  wheel.grousers = {.height_m = 0.005, .count = 24.0, .thrust = 0.0, .braking = 0.0, .shear_by_spacing = 1.0};
  return wheel;
}

WheelForces balanced(const WheelGeometry& wheel, const Soil& sand, double load_n, const WheelMotion& motion,
                     double* depth_m = nullptr) {
  const auto theta = balanced_entry_angle_rad(wheel, sand, load_n, motion);
  EXPECT_TRUE(theta.has_value());
  if (depth_m != nullptr) *depth_m = sinkage_m(wheel.radius_m, *theta);
  return wheel_forces(wheel, sand, *theta, motion);
}

TEST(WheelClosures, EveryKernelAndEveryLaneHasTheSameForces) {
  const WheelKernel* kernels[3] = {};
  const int count = wheel_kernels(kernels, 3);
  std::vector<WheelNumbers> wheels;
  for (const double theta : {0.3, 0.9, 1.4, 1.9, 2.3})
    for (const double u : {0.1, 0.8, 1.6, 20.0})
      for (const double across : {0.0, -0.3, 1.2})
        wheels.push_back(numbers_of(cleated(), closed_sand(), theta, {u, across}));
  WheelGeometry pressed = cleated();
  pressed.grousers.thrust = 0.6;
  pressed.grousers.surcharge = 0.4;
  wheels.push_back(numbers_of(pressed, closed_sand(), 0.9, {0.7, 0.1}));
  wheels.push_back(numbers_of(kWheel, sandy_loam(), 0.6, {0.7, 0.1}));  // one without closures in a pack
  LawParts parts;
  for (const WheelNumbers& wheel : wheels) parts.include(wheel);
  std::vector<WheelForces> first(wheels.size()), many(wheels.size());
  for (std::size_t k = 0; k < wheels.size(); ++k) kernels[0]->one(wheels[k], parts, first[k]);
  for (int i = 0; i < count; ++i) {
    kernels[i]->many(wheels.data(), parts, many.data(), wheels.size());
    for (std::size_t k = 0; k < wheels.size(); ++k) {
      const double unit = 1e-10 * (std::abs(first[k].vertical_n) + std::abs(first[k].lateral_n) + 1.0);
      EXPECT_NEAR(first[k].drawbar_pull_n, many[k].drawbar_pull_n, unit) << kernels[i]->instruction_set << k;
      EXPECT_NEAR(first[k].lateral_n, many[k].lateral_n, unit) << kernels[i]->instruction_set << k;
      EXPECT_NEAR(first[k].vertical_n, many[k].vertical_n, unit) << kernels[i]->instruction_set << k;
      EXPECT_NEAR(first[k].torque_nm, many[k].torque_nm, unit) << kernels[i]->instruction_set << k;
    }
  }
}

// In a pack with wheels that have closures, one without has the forces that it has alone.
TEST(WheelClosures, AtTheirNeutralValuesTheForcesAreThoseWithout) {
  const WheelNumbers numbers = numbers_of({0.125, 0.16, {0.01, 24.0}, 0.9}, sandy_loam(), 0.6, {0.7, 0.1});
  LawParts without, with;
  without.include(numbers);
  ASSERT_FALSE(without.closures);
  with = without;
  with.closures = true;
  WheelForces a, b;
  wheel_kernel().one(numbers, without, a);
  wheel_kernel().one(numbers, with, b);
  EXPECT_NEAR(a.drawbar_pull_n, b.drawbar_pull_n, 1e-10 * a.vertical_n);
  EXPECT_NEAR(a.lateral_n, b.lateral_n, 1e-10 * a.vertical_n);
  EXPECT_NEAR(a.vertical_n, b.vertical_n, 1e-10 * a.vertical_n);
  EXPECT_NEAR(a.torque_nm, b.torque_nm, 1e-10 * a.vertical_n);
}

TEST(ShearRadius, RisesWithHeightAndCountFromTheRimToTheTips) {
  const double tan_phi = std::tan(0.506);
  EXPECT_EQ(shear_share_by_spacing(0.058, 0.005, 0.0, tan_phi), 0.0);
  double last = 0.0;
  for (const double count : {6.0, 12.0, 24.0, 40.0}) {
    const double share = shear_share_by_spacing(0.058, 0.005, count, tan_phi);
    EXPECT_GT(share, last);
    last = share;
  }
  EXPECT_EQ(shear_share_by_spacing(0.058, 0.005, 400.0, tan_phi), 1.0);
  EXPECT_NEAR(shear_share_by_spacing(0.15735, 0.01, 30.0, std::tan(0.5568)), 0.51, 0.01);  // Ding's wheel
}

// By its rim, a cleated wheel that is sheared at the tips slips more where it pulls as much.
TEST(ShearRadius, AWheelOfTheShearingRadiusHasTheSameForcesAtTheSameSlipByItsOwnRim) {
  Soil sand = closed_sand();
  sand.digging = {};
  WheelGeometry wheel = kWheel, larger = kWheel;
  wheel.grousers = {.height_m = 0.005, .count = 24.0, .thrust = 0.0, .braking = 0.0, .shear_share = 1.0};
  larger.radius_m = 0.063;
  const double u = 0.9;  // of the tips' speed
  double depth = 0.0, larger_depth = 0.0;
  const WheelForces a = balanced(wheel, sand, 20.0, {u * 0.063 / 0.058, 0.0}, &depth);
  const WheelForces b = balanced(larger, sand, 20.0, {u, 0.0}, &larger_depth);
  EXPECT_NEAR(a.drawbar_pull_n, b.drawbar_pull_n, 1e-6);
  EXPECT_NEAR(a.torque_nm, b.torque_nm, 1e-6);
  EXPECT_NEAR(depth, larger_depth, 1e-8);
}

TEST(Cleats, TheirThrustNeedNotBrakeInSkid) {
  WheelGeometry cleats{0.125, 0.16, {0.01, 24.0}};
  const WheelMotion skid{speed_ratio_from_slip(-0.5), 0.0}, slip{0.6, 0.0};
  const double theta = 0.6;
  const auto pull = [&](const WheelMotion& motion, double braking) {
    cleats.grousers.braking = braking;
    return wheel_forces(cleats, sandy_loam(), theta, motion).drawbar_pull_n;
  };
  EXPECT_LT(pull(skid, 1.0), pull(skid, 0.0));
  EXPECT_NEAR(pull(slip, 1.0), pull(slip, 0.0), 1e-9);
}

TEST(Cleats, ThePressureBesideThemAddsPassivePressureInTheSharesTheTextbookHas) {
  const double tan_phi = std::tan(0.6), h = 0.01, gamma = 5500.0, c = 700.0;
  const double n_phi = std::pow(tan_phi + std::sqrt(1.0 + tan_phi * tan_phi), 2);
  const double q = 9000.0;
  const double whole = 0.5 * gamma * h * h * n_phi + q * h * n_phi + 2.0 * c * h * std::sqrt(n_phi);
  EXPECT_NEAR(passive_pressure_n(1.0, h, gamma, c, tan_phi) *
                  (1.0 + q * grouser_surcharge_per_pa(h, gamma, c, tan_phi)),
              whole, 1e-9 * whole);
  EXPECT_EQ(grouser_surcharge_per_pa(0.0, gamma, 0.0, tan_phi), 0.0) << "no cleat";

  // On a wheel: more pull and more torque, the more of the pressure presses.
  WheelGeometry cleats;
  cleats.grousers = {.height_m = h, .count = 24.0};
  const Soil soil = loose_sand();
  const WheelMotion motion{.forward = 0.8, .leftward = 0.0};
  WheelForces before = wheel_forces(cleats, soil, 0.6, motion);
  for (const double share : {0.1, 0.5, 1.0}) {
    cleats.grousers.surcharge = share;
    const WheelForces more = wheel_forces(cleats, soil, 0.6, motion);
    EXPECT_GT(more.drawbar_pull_n, before.drawbar_pull_n) << share;
    EXPECT_GT(more.torque_nm, before.torque_nm) << share;
    before = more;
  }
}

TEST(DugDepth, IsNothingWithoutSlipRisesWithSlipAndCleatsAndIsBounded) {
  const auto depth = [](double u, double cleat_dug) {
    return dug_depth_m(0.01, 0.6, cleat_dug, 0.2, 0.0, u, u);
  };
  EXPECT_EQ(depth(1.0, 0.003), 0.0);
  EXPECT_EQ(depth(3.0, 0.003), 0.0);
  double last = 0.0;
  for (const double slip : {0.1, 0.3, 0.6, 0.9, 0.99, 1.0}) {
    EXPECT_GT(depth(1.0 - slip, 0.003), last);
    last = depth(1.0 - slip, 0.003);
    EXPECT_GT(last, depth(1.0 - slip, 0.001));
  }
  EXPECT_LE(last, 0.01 + 0.003 * 5.0 + 1e-9);
  EXPECT_NEAR(depth(0.5, 0.003) - depth(0.5, 0.0), 0.003 / 1.2, 1e-9);  // h i / (1 - i), with its limit
}

TEST(Digging, LowersTheWheelAndNeverRaisesItsPull) {
  Soil flat = closed_sand();
  flat.digging = {};
  for (const double slip : {0.1, 0.3, 0.6, 0.9}) {
    const WheelMotion motion{1.0 - slip, 0.0};
    double dug = 0.0, undug = 0.0;
    const WheelForces deep = balanced(cleated(), closed_sand(), 20.0, motion, &dug);
    const WheelForces shallow = balanced(cleated(), flat, 20.0, motion, &undug);
    EXPECT_GT(dug, undug + 0.001) << slip;
    EXPECT_LE(deep.drawbar_pull_n, shallow.drawbar_pull_n + 1e-6) << slip;
  }
}

// At the balance of one wheel on one sand, as deep as it digs: the soil that is carried out costs pull and
// torque, more the deeper.
TEST(Digging, CostsTheMoreTheDeeperItIs) {
  Soil sand = closed_sand();
  double pull_n = std::numeric_limits<double>::infinity(), torque_nm = 0.0, last_depth_m = 0.0;
  for (const double share : {0.0, 0.1, 0.2, 0.4}) {
    sand.digging.rim_share = share;
    double depth_m = 0.0;
    const WheelForces f = balanced(kWheel, sand, 20.0, {0.1, 0.0}, &depth_m);
    EXPECT_GT(depth_m, last_depth_m);
    EXPECT_LT(f.drawbar_pull_n, pull_n) << share;
    EXPECT_GT(f.torque_nm, torque_nm) << share;
    pull_n = f.drawbar_pull_n, torque_nm = f.torque_nm, last_depth_m = depth_m;
  }
}

// And no less than the work to lift it by half of its depth on every metre.
TEST(Digging, TakesThePowerThatLiftsTheSoil) {
  Soil flat = ding_like(), dug = ding_like();
  dug.digging = {.rim_share = 0.3, .rim_slip = 0.65, .cleat_share = 0.0, .cleat_limit = 5.0, .sideways = 0.0};
  for (const double u : {0.2, 0.4, 0.7}) {
    double deep_m = 0.0, shallow_m = 0.0;
    const WheelGeometry wheel{0.125, 0.16};
    const WheelForces deep = balanced(wheel, dug, 100.0, {u, 0.0}, &deep_m);
    const WheelForces shallow = balanced(wheel, flat, 100.0, {u, 0.0}, &shallow_m);
    const double z = deep_m - shallow_m;
    // Power over the wheel's speed, N.
    const double more = (deep.torque_nm - shallow.torque_nm) / (u * wheel.radius_m) -
                        (deep.drawbar_pull_n - shallow.drawbar_pull_n);
    EXPECT_GT(more, 0.5 * dug.unit_weight_n_m3() * wheel.width_m * z * z) << u;
  }
}

// A soil that drew a deep rim down bore less at a greater depth, and the pull of a balanced wheel jumped by
// twelve loads from one depth to another.
TEST(WheelLaw, NoPullJumps) {
  const Soil soils[] = {make_soil({1400.0, 820000.0, 1.0}, 1000.0, 45.0, 0.018, 0.4, 0.2),
                        make_soil({1400.0, 820000.0, 1.0}, 15000.0, 25.0, 0.0152, 0.43, 0.32), ding_like(),
                        sandy_loam()};
  constexpr double kStep = 2e-4, kLoad_n = 107.6;
  for (const Soil& soil : soils)
    for (const bool ploughs : {false, true}) {
      Soil met = soil;
      if (ploughs) met.ploughing = {.front = 8.5, .wall = 12.0, .heap = 1.7, .wall_friction = 0.43};
      double last = std::numeric_limits<double>::quiet_NaN();
      for (double slip = -0.98; slip < 0.95; slip += kStep) {
        const WheelMotion motion{slip < 0.0 ? 1.0 / (1.0 + slip) : 1.0 - slip, 0.0};
        const auto theta = balanced_entry_angle_rad({0.125, 0.16}, met, kLoad_n, motion);
        const double pull = theta ? wheel_forces({0.125, 0.16}, met, *theta, motion).drawbar_pull_n / kLoad_n
                                  : std::numeric_limits<double>::quiet_NaN();
        EXPECT_FALSE(std::abs(pull - last) > 0.02) << slip << " " << ploughs << " " << soil.cohesion_pa;
        last = pull;
      }
    }
}

// Cleats as tall as half of the rim in slight skid, and a wall whose friction is that of several wheels.
TEST(WheelLaw, GivesTheAxleNoMoreThanTheGroundGives) {
  WheelGeometry tall = cleated();
  tall.grousers.height_m = 0.05, tall.grousers.mobilisation = 0.02, tall.grousers.surcharge = 1.0;
  Soil walled = closed_sand();
  walled.ploughing.wall = 60.0, walled.ploughing.wall_friction = 1.5;
  int at_the_limit = 0;
  for (const auto& [wheel, soil] : {std::pair{tall, sandy_loam()}, {cleated(), walled}, {tall, walled}})
    for (double forward = 0.02; forward < 2.0; forward += 0.02)
      for (const double sideways : {0.0, 0.3 * forward, -forward}) {
        const auto theta = balanced_entry_angle_rad(wheel, soil, 60.0, {forward, sideways});
        if (!theta) continue;
        const WheelForces f = wheel_forces(wheel, soil, *theta, {forward, sideways});
        const double lost_n =
            f.torque_nm / wheel.radius_m - forward * f.drawbar_pull_n - sideways * f.lateral_n;
        EXPECT_GT(lost_n, -1e-6) << forward << " " << sideways;
        at_the_limit += lost_n < 1e-6;
      }
  EXPECT_GT(at_the_limit, 0);
}

TEST(InclinedLoad, TakesNothingFromAWheelThatDrivesAndMostFromALockedOne) {
  EXPECT_EQ(inclined_load_share(2.0, 1.0, 1.0), 1.0);
  EXPECT_EQ(inclined_load_share(2.0, 0.2, 0.2), 1.0);
  EXPECT_NEAR(inclined_load_share(2.0, 2.0, 2.0), std::exp(-1.0), 1e-12);  // skid 0.5
  EXPECT_NEAR(inclined_load_share(2.0, 1e9, 1e9), std::exp(-2.0), 1e-6);
  EXPECT_NEAR(inclined_load_share(2.0, 0.0, 0.5), std::exp(-2.0), 1e-12);  // straight sideways
  EXPECT_EQ(inclined_load_share(0.0, 5.0, 7.0), 1.0);
}

TEST(SlipDirectedShear, KeepsTheResultantWithinTheStrengthAndPointsAgainstTheSliding) {
  Soil sand = closed_sand();
  sand.digging = {};
  sand.ploughing = {};
  sand.inclined_softening = 0.0;
  sand.cohesion_pa = 0.0;
  sand.shear_modulus_x_m = sand.shear_modulus_y_m = 1e-5;  // fully mobilised everywhere
  // A wheel so large that its contact is nearly flat: it slides back at 0.6 and to the left at 0.8.
  const WheelForces f = wheel_forces({20.0, 0.16}, sand, 0.004, {0.4, 0.8});
  const double shear = std::hypot(f.torque_nm / 20.0, f.lateral_n);
  EXPECT_LT(shear, f.vertical_n * std::tan(sand.friction_angle_rad) * 1.02);
  EXPECT_NEAR(-f.lateral_n / (f.torque_nm / 20.0), 0.8 / 0.6, 0.02);
}

TEST(WallDepthSquare, IsTheIntegralOverTheBuriedWallAlsoBelowTheAxle) {
  for (const double theta : {0.4, 1.2, 1.5707963, 1.9, 2.4}) {
    const double r = 0.058, h = r * std::cos(theta);
    double sum = 0.0;  // twice the moment of the buried wall's depth, row by row
    constexpr int kRows = 20000;
    for (int i = 0; i < kRows; ++i) {
      const double y = -r + (r - h) * (i + 0.5) / kRows;  // from the axle, up; the surface is at -h
      sum += 2.0 * (-h - y) * 2.0 * std::sqrt(r * r - y * y) * (r - h) / kRows;
    }
    EXPECT_NEAR(wall_depth_square_m3(r, theta, std::sin(theta), std::cos(theta)), sum, 1e-5 * sum) << theta;
  }
}

TEST(Ploughing, AWheelMovedSidewaysStandsDeeperThanItsAxleAndIsHeldAtTwiceItsLoad) {
  const Soil sand = closed_sand();
  const WheelMotion sideways{0.0, 0.1};  // the rim at ten times the travel's speed
  double depth = 0.0;
  const WheelForces f = balanced(cleated(), sand, 15.0, sideways, &depth);
  EXPECT_GT(depth, cleated().radius_m);
  EXPECT_GT(-f.lateral_n, 2.0 * 15.0);
  EXPECT_NEAR(f.vertical_n, 15.0, 1e-6);
  const WheelForces mirrored = balanced(cleated(), sand, 15.0, {0.0, -0.1});
  EXPECT_NEAR(mirrored.lateral_n, -f.lateral_n, 1e-9);
  EXPECT_NEAR(mirrored.drawbar_pull_n, f.drawbar_pull_n, 1e-9);
  EXPECT_EQ(max_entry_angle_rad(sandy_loam()), kMaxEntryAngleRad);
}

TEST(Ploughing, ALockedWheelPushesItsHeapAndATurningOneCarriesItAway) {
  double last = 1e9;
  for (const double speed : {1000.0, 2.0, 1.0, 0.5, 0.1}) {
    const double heap = heap_factor(1.7, 1.0 / 1.8, speed);
    EXPECT_LT(heap, last);
    last = heap;
  }
  EXPECT_NEAR(heap_factor(1.7, 1.0 / 1.8, 1e9), 2.7, 1e-6);
  EXPECT_NEAR(heap_factor(1.7, 1.0 / 1.8, 1e-4), 1.0, 1e-6);
}

TEST(HyperbolicShear, HasHalfOfTheStrengthAtItsModulusAndNineTenthsAtNine) {
  EXPECT_EQ(hyperbolic_mobilised(0.0), 0.0);
  EXPECT_EQ(hyperbolic_mobilised(1.0), 0.5);
  EXPECT_EQ(hyperbolic_mobilised(9.0), 0.9);
}

// Much of the pull is there at slip 0.1, and it still rises at slip 0.5, where an exponential's has ended.
TEST(HyperbolicShear, IsThereEarlierAndEndsLaterThanAnExponential) {
  Soil exponential = sandy_loam(), hyperbola = sandy_loam();
  exponential.shear_modulus_x_m = 0.004;
  hyperbola.shear_modulus_x_m = 0.002;
  hyperbola.shear_law.row = &kHyperbolicShear;
  const auto torque = [](const Soil& soil, double slip) {
    return wheel_forces({0.125, 0.16}, soil, 0.5, {1.0 - slip, 0.0}).torque_nm;
  };
  EXPECT_GT(torque(hyperbola, 0.05), torque(exponential, 0.05));
  EXPECT_LT(torque(hyperbola, 0.6), torque(exponential, 0.6));
  EXPECT_GT(torque(hyperbola, 0.6) / torque(hyperbola, 0.3),
            torque(exponential, 0.6) / torque(exponential, 0.3));
}

// Numbers that describe a soil without any closure are not added to a soil that has it, unless they are
// stated.
TEST(ClosureEffects, AreNotAddedByDefaultToASoilThatHasThem) {
  const auto refused = [](const char* name, EffectParameters parameters, const Soil& soil) {
    const EffectSetting setting{.name = name, .parameters = {parameters.begin(), parameters.end()}};
    return doubled(std::span(&setting, 1), soil, "sand").size();
  };
  const Soil sand = closed_sand();
  EXPECT_EQ(refused("ploughing", {}, sand), 2U);
  EXPECT_EQ(refused("ploughing", {{"front", 1.0}}, sand), 1U);
  EXPECT_EQ(refused("ploughing", {{"front", 1.0}, {"wall", 3.0}}, sand), 0U);
  EXPECT_EQ(refused("digging", {}, sand), 2U);
  EXPECT_EQ(refused("inclined_load", {}, sand), 1U);
  EXPECT_EQ(refused("slip_directed_shear", {}, sand), 0U);  // the soil's own is all of it
  // The same force by other equations.
  EXPECT_EQ(refused("bulldozing", {}, sand), 1U);
  EXPECT_EQ(refused("bulldozing", {{"share", 0.5}}, sand), 0U);
  EXPECT_EQ(refused("side_bulldozing", {}, sand), 1U);
  const EffectSetting both[] = {{.name = "bulldozing", .parameters = {}},
                                {.name = "ploughing", .parameters = {}}};
  EXPECT_EQ(doubled(both, sandy_loam(), "loam").size(), 1U);
  for (const Effect& effect : effect_catalogue())
    EXPECT_EQ(refused(std::string(effect.name).c_str(), {}, sandy_loam()), 0U) << effect.name;
}

TEST(ClosureEffects, AddToWhatASoilAndItsWheelHaveAlready) {
  Soil sand = closed_sand();
  const std::vector<EffectSetting> settings{{.name = "digging", .parameters = {{"rim_share", 0.1}}},
                                            {.name = "ploughing", .parameters = {{"wall", 3.0}}},
                                            {.name = "inclined_load", .parameters = {{"softening", 0.5}}}};
  apply_effects(settings, sand);
  EXPECT_NEAR(sand.digging.rim_share, 0.27, 1e-12);
  EXPECT_NEAR(sand.ploughing.wall, 15.0, 1e-12);
  EXPECT_NEAR(sand.inclined_softening, 2.6, 1e-12);
  RoverModel rover = six_wheeler();
  const EffectSetting cleats{.name = "cleat_shear_radius", .parameters = {}};
  apply_effects(std::span(&cleats, 1), rover);
  EXPECT_FALSE(rover.wheels[0].grousers.has_value());  // no cleats to hold soil
  rover.wheels[0].grousers = Grousers{.height_m = 0.01, .count = 24.0};
  apply_effects(std::span(&cleats, 1), rover);
  EXPECT_EQ(rover.wheels[0].grousers->shear_by_spacing, 1.0);
  EXPECT_EQ(rover.wheels[0].grousers->thrust, 0.0);
}

}  // namespace
}  // namespace slipway::sim
