// A corrected model on another campaign's drives: whose rover and soils it stands in for, and what becomes of
// the predictions.
#include "api/requests/model_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "made_diagnosis.h"

namespace slipway::api {
namespace {

// A few drives of p05.
const gap::DriveCampaign& campaign() {
  static const gap::DriveCampaign kCampaign = [] {
    gap::DriveCampaign some = testing::practice_campaign();
    some.drives.resize(6);
    return some;
  }();
  return kCampaign;
}

// The campaign's own rover and soils under the names of a model.
ModelFolder its_own() {
  ModelFolder folder{"other", campaign().rover->name, {}, {}};
  folder.model.rover = *campaign().rover;
  folder.model.rover.name += "-other-1";
  for (const gap::NominalSoil& soil : campaign().soils) {
    folder.nominal_soils.push_back(soil.name);
    folder.model.soils.emplace_back();
    folder.model.soils.back().name = soil.name + "-other-1";
    folder.model.soils.back().mean = soil.soil;
  }
  return folder;
}

ModelCheckAnswer checked(const ModelFolder& model) {
  gap::ModelCheckOptions options;
  options.threads = 1;
  options.resamples = 50;
  NoProgress progress;
  const auto answer = check_model(campaign(), model, {}, options, progress);
  if (!answer) throw std::runtime_error(answer.error().detail);
  return *answer;
}

const gap::ChannelCheck& of(const ModelCheckAnswer& answer, gap::Channel channel) {
  const auto& all = answer.check.channels;
  return *std::find_if(all.begin(), all.end(), [&](const gap::ChannelCheck& c) {
    return c.channel == channel && c.slope == gap::SlopeClass::kAll;
  });
}

TEST(ModelCheck, OfTheNominalModelItselfBringsNothingDown) {
  const ModelCheckAnswer answer = checked(its_own());
  ASSERT_FALSE(answer.check.channels.empty());
  for (const gap::ChannelCheck& c : answer.check.channels) {
    EXPECT_EQ(c.rms.nominal, c.rms.corrected) << gap::name_of(c.channel);
    EXPECT_EQ(c.median.down_percent, 0.0);
  }
  EXPECT_EQ(answer.check.drives, 6U);
  EXPECT_EQ(answer.soils, std::vector<std::string>{"nominal-other-1"});
}

// Motors of twice the constant draw half the current above the idle one, and nothing else is another.
TEST(ModelCheck, OfWrongMotorsIsWorseInCurrentAlone) {
  ModelFolder wrong = its_own();
  wrong.model.rover.drive.torque_constant_nm_per_a *= 2.0;
  const ModelCheckAnswer answer = checked(wrong);
  const gap::ErrorChange& current = of(answer, gap::Channel::kCurrent).rms;
  EXPECT_LT(current.down_percent, -20.0);
  ASSERT_TRUE(current.down_interval);
  EXPECT_LT(current.down_interval->high, 0.0);
  EXPECT_LT(of(answer, gap::Channel::kCurrent).within_90, 0.5);
  EXPECT_NEAR(of(answer, gap::Channel::kSlip).rms.down_percent, 0.0, 1e-3);
}

// The same wrong motors, known to be very uncertain: the currents are in the interval, and
// nothing else is told any less surely.
TEST(ModelCheck, HoldsWhatIsLeftOpenOfMotorsAndEffects) {
  ModelFolder wrong = its_own();
  wrong.model.rover.drive.torque_constant_nm_per_a *= 2.0;
  const ModelCheckAnswer sure = checked(wrong);
  wrong.model.left_open = gap::ParameterPosterior{{"torque_constant"}, Eigen::MatrixXd::Constant(1, 1, 9.0)};
  const ModelCheckAnswer open = checked(wrong);
  EXPECT_GT(of(open, gap::Channel::kCurrent).within_90, 0.95);
  EXPECT_EQ(of(open, gap::Channel::kSlip).within_90, of(sure, gap::Channel::kSlip).within_90);
  EXPECT_EQ(of(open, gap::Channel::kCurrent).rms.corrected, of(sure, gap::Channel::kCurrent).rms.corrected);

  ModelFolder sinking = its_own();
  sinking.model.rover.effects = {{.name = "slip_sinkage", .parameters = {{"n1", 3.0}}}};
  const ModelCheckAnswer deep = checked(sinking);
  sinking.model.left_open =
      gap::ParameterPosterior{{"slip_sinkage.n1"}, Eigen::MatrixXd::Constant(1, 1, 9.0)};
  const ModelCheckAnswer perhaps = checked(sinking);
  EXPECT_EQ(of(deep, gap::Channel::kSinkage).rms.corrected,
            of(perhaps, gap::Channel::kSinkage).rms.corrected);
  EXPECT_GT(of(perhaps, gap::Channel::kSinkage).within_90, of(deep, gap::Channel::kSinkage).within_90);
}

// A torque constant that currents show may imply more voltage than there is: the drives were made all the
// same.
TEST(ModelCheck, IsOfDrivesThatWereMade) {
  ModelFolder weak = its_own();
  weak.model.rover.drive.bus_voltage_v = 1.0;
  weak.model.rover.drive.max_current_a = 1e-3;
  const ModelCheckAnswer answer = checked(weak);
  EXPECT_EQ(answer.check.unanswered_corrected, 0U);
  EXPECT_EQ(of(answer, gap::Channel::kSlip).rms.down_percent, 0.0);
  EXPECT_EQ(of(answer, gap::Channel::kCurrent).rms.down_percent, 0.0);
}

TEST(ModelCheck, SaysWhereWhatIsCalledAlikeIsAnother) {
  const auto others = [](const ModelCheckAnswer& answer) {
    return std::count_if(answer.notes.begin(), answer.notes.end(), [](const std::string& note) {
      return note.find("has other nominal values") != std::string::npos;
    });
  };
  ModelFolder folder = its_own();
  folder.rover_digest = digest_of(*campaign().rover);
  folder.soil_digests = {digest_of(campaign().soils.front())};
  EXPECT_EQ(others(checked(folder)), 0);
  sim::RoverModel heavier = *campaign().rover;
  heavier.drive.max_wheel_rate_rad_s *= 2.0;
  EXPECT_EQ(digest_of(heavier), folder.rover_digest);
  heavier.mass_kg *= 2.0;
  gap::NominalSoil softer = campaign().soils.front();
  softer.soil.friction_angle_rad *= 0.5;
  folder.rover_digest = digest_of(heavier);
  folder.soil_digests = {digest_of(softer)};
  EXPECT_EQ(others(checked(folder)), 2);
}

TEST(ModelCheck, NeedsTheModelsRoverAndSoils) {
  ModelFolder other = its_own();
  other.nominal_rover = "rover-of-others";
  other.nominal_soils = {"sand"};
  const auto refused = belief_of(campaign(), other, {});
  ASSERT_FALSE(refused);
  ASSERT_EQ(refused.error().faults.size(), 2U);
  EXPECT_EQ(refused.error().faults[0].pointer, "/rover/name");
  EXPECT_EQ(refused.error().faults[1].pointer, "/soils/nominal");
  other.nominal_rover = campaign().rover->name;
  const auto named = belief_of(campaign(), other, {"nominal"});
  ASSERT_TRUE(named);
  EXPECT_EQ(named->soils.at(0).name, "nominal-other-1");
}

}  // namespace
}  // namespace slipway::api
