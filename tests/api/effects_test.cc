#include <gtest/gtest.h>

#include <cmath>

#include "api/documents/prediction_request.h"
#include "api/files/rover_file.h"
#include "api/requests/soil_regions.h"
#include "api/service_drives.h"
#include "core/angle.h"
#include "tests/api/small_world.h"

namespace slipway::api {
namespace {

using testing::example;
using testing::small_world;

PredictionRequest path_request() {
  return json::read_prediction_request(example("prediction_path.json"))->request;
}

sim::DrivePrediction predicted(const PredictionRequest& request) {
  NoProgress progress;
  const auto answer = run_prediction(small_world(), request, progress);
  EXPECT_TRUE(answer) << (answer ? "" : answer.error().detail);
  return answer->prediction;
}

TEST(Effects, ASwitchedOffEffectOfARequestChangesNothing) {
  PredictionRequest request = path_request();
  request.drive.effects = {};
  const sim::DrivePrediction without = predicted(request);
  request.drive.effects = {{"bulldozing", {{"share", 0.2}}, false}};
  EXPECT_EQ(predicted(request).energy_j, without.energy_j);
  request.drive.effects = {{"bulldozing", {{"share", 0.2}}, true}};
  EXPECT_GT(predicted(request).energy_j, without.energy_j);
}

TEST(Effects, ARoversFileCarriesItsOwnAndGivesThemBack) {
  std::string file = testing::file_bytes(std::string(SLIPWAY_DATA_FOLDER) + "/rovers/mer-class.json");
  file.insert(file.rfind('}'), R"(, "effects": [{"name": "grousers", "parameters": {"height_m": 0.02}}])");
  const auto rover = json::read_rover_file(file);
  ASSERT_TRUE(rover) << rover.error().detail;
  ASSERT_EQ(rover->effects.size(), 1u);
  EXPECT_EQ(rover->effects[0].parameters.at("height_m"), 0.02);
  json::Writer w;
  json::write_rover(w, *rover);
  EXPECT_EQ(json::read_rover_file(w.take())->effects[0].parameters.at("height_m"), 0.02);

  file.replace(file.rfind("0.02"), 4, "7.00");
  const auto refused = json::read_rover_file(file);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().faults.front().pointer, "/effects/0/parameters/height_m");
}

TEST(Effects, ASoftPatchIsFeltWhereItLiesAndNowhereElse) {
  PredictionRequest request = path_request();
  request.drive.effects = {};
  const sim::DrivePrediction plain = predicted(request);
  const std::size_t middle = plain.stations.size() / 2;
  const Pose2 place = plain.stations[middle].station.pose;
  request.drive.effects = {
      {"soft_patch", {{"x_m", place.x_m}, {"y_m", place.y_m}, {"radius_m", 2.5}, {"weakening", 0.2}}}};
  const sim::DrivePrediction soft = predicted(request);
  ASSERT_EQ(soft.stations.size(), plain.stations.size());
  EXPECT_GT(soft.stations[middle].state.wheels[0].sinkage_m,
            plain.stations[middle].state.wheels[0].sinkage_m);
  int same = 0;
  for (std::size_t k = 0; k < soft.stations.size(); ++k) {
    const Pose2& at = plain.stations[k].station.pose;
    if (std::hypot(at.x_m - place.x_m, at.y_m - place.y_m) < 5.0) continue;
    EXPECT_NEAR(soft.stations[k].state.slip_ratio, plain.stations[k].state.slip_ratio, 1e-7) << k;
    ++same;
  }
  EXPECT_GT(same, 0) << "the path leaves the patch";
}

TEST(Effects, ASoilInAPatchHasANameOfItsOwn) {
  dem::GridGeometry grid{.rows = 2, .columns = 3, .west_m = 0.0, .north_m = 2.0};
  const auto map = std::make_shared<const dem::SoilMap>(grid, std::vector<std::int16_t>{1, 1, 0, 1, 1, 0},
                                                        std::vector<std::uint8_t>{1, 1, 0, 1, 1, 0},
                                                        std::vector<dem::SoilClass>{{1, "sand", "loose"}});
  const RegionalSoils soils = soils_in_regions(map, {{2.0, 1.0, 0.8}}, "dust");
  ASSERT_EQ(soils.soils.size(), 3u);
  EXPECT_EQ(soils.soils[0].name(), "loose");
  EXPECT_EQ(soils.map->soils()[*soils.map->soil_at(0.5, 0.5)], "loose");
  EXPECT_EQ(soils.map->soils()[*soils.map->soil_at(1.5, 0.5)], "loose@place_1");
  EXPECT_EQ(soils.map->soils()[*soils.map->soil_at(2.5, 1.5)], "dust@place_1");
  EXPECT_EQ(soils_in_regions(map, {}, "dust").map, map) << "without regions it is the same map";
}

// A patch that weakens nothing leaves the soil that the request assumes, and one that weakens makes it no
// firmer.
TEST(Effects, APatchIsOfTheSoilThatTheRequestAssumes) {
  PredictionRequest request = path_request();
  request.path = {{115.0, 40.0, {}}, {115.0, 46.0, {}}};  // where the map names no soil
  const auto sinkage_m = [&](const char* soil, std::optional<double> weakening) {
    request.drive.unknown_soil = soil;
    request.drive.effects.clear();
    if (weakening)
      request.drive.effects = {{"soft_patch",
                                {{"x_m", request.path[0].x_m},
                                 {"y_m", request.path[0].y_m},
                                 {"radius_m", 900.0},
                                 {"weakening", *weakening}}}};
    return predicted(request).max_sinkage_m.value;
  };
  for (const char* soil : {"jlu_mars_2_loose", "sandy_loam"}) {
    const double plain = sinkage_m(soil, {});
    EXPECT_NEAR(sinkage_m(soil, 0.0), plain, 1e-6 * plain) << soil;
    EXPECT_GT(sinkage_m(soil, 0.3), plain) << soil;
  }
}

TEST(Effects, AWheelThatTheRoverDoesNotHaveIsRefusedByItsNumber) {
  const auto refused = read_prediction(
      small_world(),
      R"({"terrain":"yard","rover":"mer-class","path":[{"x_m":20,"y_m":30},{"x_m":28,"y_m":30}],)"
      R"("effects":[{"name":"dragging_wheel","parameters":{"wheel":6}}]})");
  ASSERT_FALSE(refused);
  ASSERT_EQ(refused.error().faults.size(), 1u);
  EXPECT_EQ(refused.error().faults[0].pointer, "/effects/0/parameters/wheel");
  EXPECT_NE(refused.error().faults[0].message.find("mer-class has 6 wheels"), std::string::npos);
}

TEST(Effects, AColdMotorDrawsOtherCurrentAndATemperatureThatNothingReadsIsRefused) {
  PredictionRequest request = path_request();
  request.drive.effects = {};
  const double plain = predicted(request).energy_j;
  request.drive.effects = {{"motor_temperature", {}}};
  EXPECT_EQ(predicted(request).energy_j, plain) << "without a temperature the motors are as they are given";
  request.drive.conditions.motor_temp_c = -60.0;
  EXPECT_NE(predicted(request).energy_j, plain);
  const auto refused = read_prediction(
      small_world(),
      R"({"terrain":"yard","rover":"mer-class","path":[{"x_m":20,"y_m":30},{"x_m":28,"y_m":30}],"motor_temp_c":-60})");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().faults[0].pointer, "/motor_temp_c");
}

TEST(Effects, ADraggingWheelShowsInTheYawRate) {
  PredictionRequest request = path_request();
  request.drive.effects = {{"dragging_wheel", {{"wheel", 0.0}}}};
  const sim::DrivePrediction left = predicted(request);
  request.drive.effects = {{"dragging_wheel", {{"wheel", 3.0}}}};
  const sim::DrivePrediction right = predicted(request);
  EXPECT_GT(left.stations[5].state.yaw_rate_rad_s, 0.0) << "it turns about the wheel that drags";
  EXPECT_LT(right.stations[5].state.yaw_rate_rad_s, 0.0);
}

TEST(Manner, ThePathIsTheSameBackwardsAndInCrabButTheBodyPointsElsewhere) {
  PredictionRequest request = path_request();
  for (planner::Waypoint& corner : request.path) corner.yaw_rad.reset();
  const sim::DrivePrediction forwards = predicted(request);
  request.manner = {.backwards = true, .crab_rad = 0.0};
  const sim::DrivePrediction backwards = predicted(request);
  ASSERT_EQ(backwards.stations.size(), forwards.stations.size());
  const std::size_t last = forwards.stations.size() - 1;
  EXPECT_NEAR(backwards.stations[last].station.pose.x_m, forwards.stations[last].station.pose.x_m, 1e-9);
  EXPECT_NEAR(std::abs(wrapped_rad(backwards.stations[last].station.pose.yaw_rad -
                                   forwards.stations[last].station.pose.yaw_rad)),
              M_PI, 1e-9);
  EXPECT_LT(backwards.stations[last].state.forward_m_s, 0.0);
  request.manner = {.backwards = false, .crab_rad = rad_from_deg(20.0)};
  const sim::DrivePrediction crab = predicted(request);
  EXPECT_NEAR(
      wrapped_rad(forwards.stations[last].station.pose.yaw_rad - crab.stations[last].station.pose.yaw_rad),
      rad_from_deg(20.0), 1e-9);
}

}  // namespace
}  // namespace slipway::api
