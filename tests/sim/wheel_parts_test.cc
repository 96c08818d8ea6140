#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/single_wheel/zhurong_literal.h"
#include "sim/soil/bekker_pressure.h"
#include "sim/soil/bulldozing_law.h"
#include "sim/soil/duricrust_law.h"
#include "sim/soil/hardpan_law.h"
#include "sim/soil/janosi_hanamoto.h"
#include "sim/soil/soil_in_force.h"
#include "sim/soil/terzaghi.h"
#include "sim/wheel/entry_angle.h"
#include "sim/wheel/slip_ratio.h"
#include "tests/sim/reference_models.h"

// Where a wheel stands, and the laws of the soil that its forces are made of.
namespace slipway::sim {
namespace {

constexpr WheelGeometry kWheel{0.125, 0.16};

TEST(EntryAngle, TheBalancedWheelCarriesItsLoad) {
  for (const double load : {5.0, 50.0, 300.0}) {
    const WheelMotion motion{0.8, 0.05};
    const auto theta = balanced_entry_angle_rad(kWheel, sandy_loam(), load, motion);
    ASSERT_TRUE(theta);
    EXPECT_NEAR(wheel_forces(kWheel, sandy_loam(), *theta, motion).vertical_n, load, 1e-9 * load);
  }
}

// Its own grip draws no part of the rim down: deeper soil carries more.
TEST(EntryAngle, ABrakedWheelInCohesiveSoilStandsAtTheShallowestDepthThatCarriesIt) {
  Soil soil = ding_like();
  soil.cohesion_pa = 20000.0;
  soil.friction_angle_rad = rad_from_deg(40.0);
  const WheelMotion motion{speed_ratio_from_slip(-0.9), 0.0};
  const double load = 200.0;
  EXPECT_GT(wheel_forces(kWheel, soil, kMaxEntryAngleRad, motion).vertical_n, load);
  const auto theta = balanced_entry_angle_rad(kWheel, soil, load, motion);
  ASSERT_TRUE(theta) << theta.error().detail;
  EXPECT_NEAR(wheel_forces(kWheel, soil, *theta, motion).vertical_n, load, 1e-9 * load);
  for (double shallower = 0.02; shallower < *theta - 0.03; shallower += 0.02)
    EXPECT_LT(wheel_forces(kWheel, soil, shallower, motion).vertical_n, load) << shallower;
}

TEST(EntryAngle, AWheelStandsOnACrustThatCarriesItAndBelowOneThatDoesNot) {
  Soil soil = ding_like();
  soil.crust = {100'000.0, 0.02};
  soil.pressure = {0.0, 20000.0, 1.1};
  const auto standing = balanced_entry_angle_rad(kWheel, soil, 300.0, {0.8, 0.0});
  ASSERT_TRUE(standing);
  EXPECT_LT(sinkage_m(kWheel.radius_m, *standing), 0.02);
}

TEST(EntryAngle, ALoadThatNoDepthCarriesIsRefusedWithWhatItWouldCarry) {
  const auto theta = balanced_entry_angle_rad(kWheel, loose_sand(), 1e6, {0.9, 0.0});
  ASSERT_FALSE(theta);
  EXPECT_EQ(theta.error().code, ErrorCode::kNotConverged);
  EXPECT_NE(theta.error().detail.find("sunk to the axle"), std::string::npos);
}

TEST(ZhurongLiteral, ZeroSlipInTheDenseSecondSimulantGivesThePublishedTorqueAndCurrent) {
  Soil soil = make_soil({314413.0, 7432759.0, 1.12}, 800.0, 39.3, 0.0192, 0.43, 0.32);
  const ZhurongLiteral literal = zhurong_literal({0.1475, 0.2}, soil, 34.08 * 9.81, 0.0);
  EXPECT_NEAR(literal.torque_nm, 1.427, 0.001);
  EXPECT_NEAR(literal.sinkage_m, 0.0097, 0.00005);
  EXPECT_NEAR(literal.torque_nm / kZhurongTorqueFactor / kZhurongImpliedGearRatio, 0.114, 0.0005);
}

TEST(SlipRatio, SpeedRatioAndSlipAreInverse) {
  for (const double slip : {-0.9, -0.3, 0.0, 0.4, 0.99})
    EXPECT_NEAR(slip_from_speed_ratio(speed_ratio_from_slip(slip)), slip, 1e-15);
}

TEST(JanosiHanamoto, RisesFromNothingToTheWholeStrength) {
  EXPECT_EQ(janosi_hanamoto_mobilised(0.0), 0.0);
  EXPECT_NEAR(janosi_hanamoto_mobilised(1e-6), 1e-6, 1e-11) << "the slope at the origin is 1 / K";
  double before = 0.0;
  for (const double ratio : {1e-3, 0.1, 0.5, 1.0, 5.0, 20.0, 100.0}) {
    EXPECT_GE(janosi_hanamoto_mobilised(ratio), before);
    before = janosi_hanamoto_mobilised(ratio);
  }
  EXPECT_LE(before, 1.0);
}

TEST(BekkerPressureSinkage, DoublingDepthRaisesPressureByTwoToTheN) {
  for (const double depth : {0.01, 0.03, 0.08})
    EXPECT_NEAR(bekker_pressure_pa(8e5, 1.3, 2.0 * depth) / bekker_pressure_pa(8e5, 1.3, depth),
                std::pow(2.0, 1.3), 1e-12);
}

TEST(Duricrust, CarriesItsStrengthAtTheDepthWhereItBreaksAndLessBeyond) {
  EXPECT_EQ(duricrust_pressure_pa(5000.0, 0.0), 0.0);
  EXPECT_DOUBLE_EQ(duricrust_pressure_pa(5000.0, 1.0), 5000.0);
  EXPECT_LT(duricrust_pressure_pa(5000.0, 0.9), 5000.0);
  EXPECT_LT(duricrust_pressure_pa(5000.0, 3.0), 2100.0);
}

TEST(Hardpan, PushesBackOnlyBelowItsDepth) {
  EXPECT_EQ(hardpan_pressure_pa(1e6, 0.02, 0.019), 0.0);
  EXPECT_NEAR(hardpan_pressure_pa(1e6, 0.02, 0.025), 5000.0, 1e-9);
}

TEST(PassivePressure, IsRankinesClosedForm) {
  // phi = 30 deg: N_phi = 3. P = b (gamma z^2 3 / 2 + 2 c z sqrt(3)).
  const double tan_phi = std::tan(M_PI / 6.0);
  EXPECT_NEAR(passive_pressure_n(0.2, 0.1, 15000.0, 0.0, tan_phi), 0.2 * 15000.0 * 0.01 * 1.5, 1e-9);
  EXPECT_NEAR(passive_pressure_n(0.2, 0.1, 0.0, 1000.0, tan_phi), 0.2 * 2000.0 * 0.1 * std::sqrt(3.0), 1e-9);
}

TEST(Terzaghi, FactorsAreThoseOfHisTable) {
  // General shear [Terzaghi 1943, as tabulated by Bowles 1996, table 4-3]: phi, N_c, N_q.
  const double table[][3] = {
      {0.0, 5.7, 1.0}, {10.0, 9.6, 2.7}, {20.0, 17.7, 7.4}, {30.0, 37.2, 22.5}, {40.0, 95.7, 81.3}};
  for (const auto& [phi_deg, n_c, n_q] : table) {
    const double phi = phi_deg * M_PI / 180.0;
    const TerzaghiFactors<double> f = terzaghi_factors(phi, std::tan(phi));
    EXPECT_NEAR(f.n_c / n_c, 1.0, 0.01) << phi_deg;
    EXPECT_NEAR(f.n_q / n_q, 1.0, 0.02) << phi_deg;
  }
}

TEST(SoilInForce, ATrackIsStifferAFastRimMeetsAnotherModulusAndGravityScalesWhereAsked) {
  Soil soil = sandy_loam();
  EXPECT_EQ(soil_in_force(soil, 1.62, 0.1, 1.0).pressure.k_phi, soil.pressure.k_phi);
  EXPECT_EQ(soil_in_force(soil, 1.62, 0.1, 1.0).gravity_m_s2, 1.62);
  soil.multipass_stiffening = 0.9;
  EXPECT_DOUBLE_EQ(soil_in_force(soil, 3.71, 0.1, 1.0).pressure.k_phi, 1.9 * soil.pressure.k_phi);
  EXPECT_EQ(soil_in_force(soil, 3.71, 0.1, 0.0).pressure.k_phi, soil.pressure.k_phi);
  soil.bulldozing = 0.7;
  EXPECT_EQ(soil_in_force(soil, 3.71, 0.1, 1.0).bulldozing, 0.0);
  EXPECT_EQ(soil_in_force(soil, 3.71, 0.1, 0.0).bulldozing, 0.7);
  soil.rate_shear_exponent = 0.5;
  EXPECT_DOUBLE_EQ(soil_in_force(soil, 3.71, 0.16, 0.0).shear_modulus_x_m, 2.0 * soil.shear_modulus_x_m);
  soil.gravity_exponent = 1.0;
  soil.measured_gravity_m_s2 = 9.81;
  EXPECT_NEAR(soil_in_force(soil, 3.71, 0.04, 0.0).pressure.k_c, soil.pressure.k_c * 3.71 / 9.81, 1e-9);
}

}  // namespace
}  // namespace slipway::sim
