#include "steps/steps_from_spice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include "daf_writer.h"
#include "steps/slip_steps_csv.h"

namespace slipway::steps {
namespace {

std::string bytes_of(const std::string& name) {
  std::ifstream stream(std::string(SLIPWAY_STEPS_DATA) + "/" + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

// A rover that heads 30 deg and drives as it is told: states, and its attitude at each.
class MadeDrive {
 public:
  MadeDrive() { state(0.0); }

  // A move along the body's x axis which pitches it a little.
  MadeDrive& drive(double metres, double seconds = 40.0) {
    north_ += metres * std::cos(kHeading);
    east_ += metres * std::sin(kHeading);
    pitch_ += 0.01;
    return state(seconds);
  }
  MadeDrive& rest(double seconds = 5.0) { return state(seconds); }
  // Visual odometry says that the rover is `back` metres behind, and `right` metres to its right.
  MadeDrive& correct(double back, double right = 0.0) {
    north_ += -back * std::cos(kHeading) - right * std::sin(kHeading);
    east_ += -back * std::sin(kHeading) + right * std::cos(kHeading);
    return state(30.0);
  }
  // The wheels slide across, which no body that drives does.
  MadeDrive& slide(double metres) {
    north_ -= metres * std::sin(kHeading);
    east_ += metres * std::cos(kHeading);
    pitch_ += 0.01;
    return state(40.0);
  }

  made::Array positions(int type = 9) const { return made::spk(type, states_); }
  made::Array attitudes() const { return made::ck(3, pointings_, false, {pointings_.front().tick}); }

 private:
  static constexpr double kHeading = 0.5;

  MadeDrive& state(double seconds) {
    et_s_ += seconds;
    states_.push_back({et_s_, {north_, east_, 0.0}});
    // Level to body: the transposed turn of heading and pitch, nose up.
    const double ch = std::cos(0.5 * kHeading), sh = std::sin(0.5 * kHeading);
    const double cp = std::cos(0.5 * pitch_), sp = std::sin(0.5 * pitch_);
    pointings_.push_back({et_s_ * 65536.0, {ch * cp, sh * sp, -ch * sp, -sh * cp}, {}, 0.0});
    return *this;
  }

  double et_s_ = 400000000.0, north_ = 10.0, east_ = -20.0, pitch_ = 0.0;
  std::vector<made::State> states_;
  std::vector<made::Pointing> pointings_;
};

Result<SpiceSteps> steps_of(const std::vector<made::Array>& positions,
                            const std::vector<made::Array>& attitudes, bool big = true) {
  const std::string spk = made::daf("DAF/SPK ", positions, big);
  const std::string ck = attitudes.empty() ? "" : made::daf("DAF/CK  ", attitudes, big);
  std::vector<KernelBytes> files{{"rover.bsp", spk}};
  if (!ck.empty()) files.push_back({"rover.bc", ck});
  if (!ck.empty()) files.push_back({"clock.tsc", made::kClock});
  return steps_from_spice(files);
}

TEST(StepsFromSpice, AStepIsADriveARestAndACorrection) {
  MadeDrive drive;
  drive.rest().drive(1.0).rest().correct(0.2, 0.05).rest().drive(-0.8).rest().correct(-0.08);
  for (const bool big : {false, true})
    for (const int type : {9, 13}) {
      const auto found = steps_of({drive.positions(type)}, {drive.attitudes()}, big);
      ASSERT_TRUE(found);
      ASSERT_EQ(found->steps.size(), 2U);
      const SlipStep& first = found->steps[0];
      EXPECT_NEAR(first.odometry_m, 1.0, 1e-9);
      EXPECT_NEAR(first.slip, 0.2, 1e-9);
      EXPECT_NEAR(first.side_m.value(), 0.05, 1e-9);
      EXPECT_NEAR(first.heading_rad.value(), 0.5, 1e-6);
      EXPECT_NEAR(first.course_rad.value(), 0.5, 1e-6);
      EXPECT_NEAR(first.climb_pitch_start_rad.value(), 0.0, 1e-6);
      EXPECT_NEAR(first.climb_pitch_end_rad.value(), 0.01, 1e-6);
      EXPECT_NEAR(first.site_north_m.value(), 10.0, 1e-9);
      EXPECT_NEAR(first.drive_s.value(), 40.0, 1e-6);
      EXPECT_EQ(first.site, 5);
      EXPECT_EQ(first.sol, 28);
      EXPECT_EQ(first.backward, false);
      EXPECT_EQ(first.attitude, StepAttitude::kCk);
      EXPECT_FALSE(first.x_eqc_m);
      const SlipStep& second = found->steps[1];
      EXPECT_EQ(second.backward, true);
      EXPECT_NEAR(second.slip, 0.1, 1e-9);
      EXPECT_NEAR(second.climb_pitch_end_rad.value(), -0.02, 1e-6);
    }
}

TEST(StepsFromSpice, RestsWithinAStepDoNotEndIt) {
  MadeDrive drive;
  drive.drive(0.5).rest().drive(0.5).rest().rest().correct(0.1);
  const auto found = steps_of({drive.positions()}, {drive.attitudes()});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->steps.size(), 1U);
  EXPECT_NEAR(found->steps[0].odometry_m, 1.0, 1e-9);
  EXPECT_NEAR(found->steps[0].slip, 0.1, 1e-9);
  EXPECT_NEAR(found->steps[0].drive_s.value(), 80.0, 1e-6);
}

TEST(StepsFromSpice, WhatIsLeftOutIsCounted) {
  MadeDrive drive;
  drive.drive(0.3).rest().correct(0.1).drive(1.2).drive(1.2).rest().correct(0.1).slide(1.0).rest().correct(
      0.1);
  drive.rest().correct(0.2).drive(1.0).rest(700.0).correct(0.1).drive(1.0).rest().correct(-1.2);
  made::Array other = drive.positions();
  other.whole[0] = -74;
  made::Array type = drive.positions();
  type.whole[3] = 5;
  const auto found = steps_of({drive.positions(), other, type}, {drive.attitudes()});
  ASSERT_TRUE(found);
  const SpiceStepSummary& s = found->summary;
  EXPECT_EQ(s.steps, 0U);
  EXPECT_EQ(s.too_short, 1U);
  EXPECT_EQ(s.too_long, 1U);
  EXPECT_EQ(s.off_axis, 1U);
  EXPECT_EQ(s.no_slip, 1U);
  EXPECT_EQ(s.gaps, 1U);
  EXPECT_EQ(s.jumps_without_drive, 2U);
  EXPECT_EQ(s.corrections, 4U);
  EXPECT_EQ(s.other_bodies, 1U);
  EXPECT_EQ(s.other_types, 1U);
  EXPECT_EQ(s.rover_segments, 1U);
}

TEST(StepsFromSpice, AStateWithoutAttitudeStartsAnew) {
  MadeDrive drive;
  drive.drive(1.0).rest().correct(0.1).drive(1.0).rest().correct(0.1);
  made::Array attitudes = drive.attitudes();
  attitudes.numbers[1] -= 40.0 * 65536.0;  // ends before the last drive does
  const auto found = steps_of({drive.positions()}, {attitudes});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->steps.size(), 1U);
  EXPECT_EQ(found->summary.without_attitude, 3U);
}

TEST(StepsFromSpice, WithoutAttitudesACorrectionIsToldByItsLengthAndDirection) {
  MadeDrive drive;
  drive.drive(1.0).rest().correct(0.2, 0.05).drive(1.0).rest().drive(0.5).rest().correct(0.15);
  const auto found = steps_of({drive.positions()}, {});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->steps.size(), 2U);
  EXPECT_NEAR(found->steps[0].slip, 0.2, 1e-9);
  EXPECT_NEAR(found->steps[0].side_m.value(), 0.05, 1e-9);
  EXPECT_EQ(found->steps[0].attitude, StepAttitude::kNone);
  EXPECT_FALSE(found->steps[0].heading_rad || found->steps[0].backward);
  EXPECT_NEAR(found->steps[1].odometry_m, 1.5, 1e-9);
  EXPECT_NEAR(found->steps[1].slip, 0.1, 1e-9);
}

TEST(StepsFromSpice, TheSameFileTwiceGivesItsStepsOnce) {
  MadeDrive drive;
  drive.drive(1.0).rest().correct(0.2);
  const std::string spk = made::daf("DAF/SPK ", {drive.positions()}, true);
  const std::vector<KernelBytes> files{{"a.bsp", spk}, {"b.bsp", spk}};
  const auto found = steps_from_spice(files);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->steps.size(), 1U);
  EXPECT_EQ(found->summary.repeated, 1U);
}

TEST(StepsFromSpice, ALandingSiteGivesPlacesOnTheMap) {
  MadeDrive drive;
  drive.drive(1.0).rest().correct(0.2);
  const double longitude = 2.4, latitude = -0.08, radius = 3391000.0;
  const std::array<double, 3> site{radius * std::cos(latitude) * std::cos(longitude),
                                   radius * std::cos(latitude) * std::sin(longitude),
                                   radius * std::sin(latitude)};
  const made::Array landing = made::spk(8, {{0.0, site}, {1e9, site}}, -76900, 499, 10014);
  const made::Array offset = made::spk(9, {{0.0, {100.0, 200.0, 3.0}}}, -76505, -76900);
  const auto found = steps_of({drive.positions(), offset, landing}, {});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->steps.size(), 1U);
  EXPECT_TRUE(found->summary.has_landing_site);
  EXPECT_NEAR(found->steps[0].x_eqc_m.value(),
              3396190.0 * (longitude + 180.0 / (radius * std::cos(latitude))), 1e-3);
  EXPECT_NEAR(found->steps[0].y_eqc_m.value(), 3396190.0 * (latitude + 110.0 / radius), 1e-3);
}

TEST(StepsFromSpice, WhatNoTableHasIsLeftOut) {
  MadeDrive drive;
  drive.drive(1.0).rest().correct(0.2).drive(1.0).rest().correct(0.1, 5000.0);
  const auto found = steps_of({drive.positions()}, {drive.attitudes()});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->steps.size(), 1U);
  EXPECT_EQ(found->summary.out_of_range, 1U);
}

TEST(StepsFromSpice, FilesThatCanNotBeUsed) {
  MadeDrive drive;
  drive.drive(1.0).rest().correct(0.2);
  const std::string spk = made::daf("DAF/SPK ", {drive.positions()}, true);
  const std::string ck = made::daf("DAF/CK  ", {drive.attitudes()}, true);
  const auto fault = [](const std::vector<KernelBytes>& files) {
    const auto found = steps_from_spice(files);
    EXPECT_FALSE(found);
    if (found) return std::string();
    EXPECT_EQ(found.error().code, ErrorCode::kUnreadableData);
    std::string all;
    for (const Fault& each : found.error().faults) all += each.pointer + ": " + each.message + "\n";
    return all;
  };
  EXPECT_NE(fault({}).find("no kernel has positions of body -76"), std::string::npos);
  EXPECT_NE(fault({{"a.bsp", spk}, {"b.bc", ck}}).find("no clock kernel of spacecraft 76"),
            std::string::npos);
  EXPECT_NE(fault({{"a.bsp", spk}, {"x", "<html>"}}).find("x: neither positions (SPK) nor"),
            std::string::npos);
  EXPECT_NE(fault({{"a.bsp", spk}, {"1", made::kClock}, {"2", made::kClock}}).find("two clock kernels"),
            std::string::npos);
  // Faults of several files are told together.
  const std::string both = fault({{"a.bsp", std::string_view(spk).substr(0, 2000)}, {"b.bsp", "DAF/SPK "}});
  EXPECT_NE(both.find("a.bsp, byte 2000"), std::string::npos);
  EXPECT_NE(both.find("b.bsp, byte 8"), std::string::npos);
}

// Curiosity's sols 89 to 179 beside the table that was made of the same kernels by others' code;
// PROVENANCE.md.
class Curiosity : public testing::Test {
 protected:
  std::string spk = bytes_of("msl_surf_rover_tlm_0089_0179_v1.bsp"),
              ck = bytes_of("msl_surf_rover_tlm_0089_0179_v1.bc"),
              clock = bytes_of("MSL_76_SCLKSCET.00013.tsc"), csv = bytes_of("curiosity_steps_0089_0179.csv");
  Result<std::vector<SlipStep>> table = read_slip_steps(csv, "table");
};

double between(const std::optional<double>& a, const std::optional<double>& b) {
  EXPECT_EQ(a.has_value(), b.has_value());
  return a && b ? std::abs(*a - *b) : 0.0;
}

TEST_F(Curiosity, EveryStepOfTheTableComesOutOfTheKernels) {
  ASSERT_TRUE(table);
  const std::vector<KernelBytes> files{{"bsp", spk}, {"bc", ck}, {"tsc", clock}};
  const auto found = steps_from_spice(files);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->steps.size(), 200U);
  ASSERT_EQ(table->size(), 200U);
  const double hundredth_deg = 0.0105 * 3.14159 / 180.0;
  for (std::size_t k = 0; k < table->size(); ++k) {
    const SlipStep &mine = found->steps[k], &theirs = (*table)[k];
    EXPECT_EQ(mine.sol, theirs.sol);
    EXPECT_EQ(mine.site, theirs.site);
    EXPECT_EQ(mine.backward, theirs.backward);
    EXPECT_EQ(mine.attitude, theirs.attitude);
    EXPECT_NEAR(mine.et_s, theirs.et_s, 0.1);
    EXPECT_NEAR(mine.odometry_m, theirs.odometry_m, 6e-5);
    EXPECT_NEAR(mine.slip, theirs.slip, 6e-5);
    EXPECT_LT(between(mine.side_m, theirs.side_m), 2e-4);
    EXPECT_LT(between(mine.site_north_m, theirs.site_north_m), 1e-3);
    EXPECT_LT(between(mine.site_east_m, theirs.site_east_m), 1e-3);
    EXPECT_LT(between(mine.site_down_m, theirs.site_down_m), 1e-3);
    EXPECT_LT(between(mine.drive_s, theirs.drive_s), 0.06);
    for (const auto angle :
         {&SlipStep::climb_pitch_start_rad, &SlipStep::climb_pitch_end_rad, &SlipStep::roll_start_rad,
          &SlipStep::roll_end_rad, &SlipStep::heading_rad, &SlipStep::path_pitch_rad, &SlipStep::course_rad})
      EXPECT_LT(between(mine.*angle, theirs.*angle), hundredth_deg);
  }
}

TEST_F(Curiosity, WithoutAttitudesNearlyAllOfThem) {
  ASSERT_TRUE(table);
  const std::vector<KernelBytes> files{{"bsp", spk}};
  const auto found = steps_from_spice(files);
  ASSERT_TRUE(found);
  std::size_t there = 0, alike = 0;
  for (const SlipStep& theirs : *table) {
    const auto mine = std::find_if(found->steps.begin(), found->steps.end(),
                                   [&](const SlipStep& s) { return std::abs(s.et_s - theirs.et_s) < 0.15; });
    if (mine == found->steps.end()) continue;
    ++there;
    if (std::abs(mine->slip - theirs.slip) < 0.01) ++alike;
  }
  EXPECT_GE(there, 198U);
  EXPECT_GE(alike, 197U);
  EXPECT_LE(found->steps.size(), 204U);
}

}  // namespace
}  // namespace slipway::steps
