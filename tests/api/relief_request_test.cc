// A relief that is drawn, from the terrain's file and the request to the answer.
#include <gtest/gtest.h>

#include "api/files/relief_values.h"
#include "api/json/parse.h"
#include "small_world.h"
#include "yard_requests.h"

namespace slipway::api {
namespace {

const testing::YardRequests kYard("mer-class");
constexpr const char* kFourMetres = R"("path":[{"x_m":20,"y_m":30},{"x_m":24,"y_m":30}],"draws":24)";

TEST(Relief, ARequestDrawsItAndTheAnswerSaysWith) {
  const auto mapped = kYard.checked(kFourMetres);
  const auto drawn = kYard.checked(std::string(kFourMetres) + R"(,"relief":{"elevation_error_m":0.2})");
  ASSERT_TRUE(mapped && drawn) << (drawn ? "" : drawn.error().detail);
  EXPECT_EQ(mapped->find("provenance")->find("relief"), nullptr);
  const json::JsonValue* const relief = drawn->find("provenance")->find("relief");
  ASSERT_NE(relief, nullptr);
  EXPECT_EQ(relief->find("elevation_error_m")->number, 0.2);
  EXPECT_EQ(relief->find("error_length_m")->number, 5.0);
  const auto width_of_tilt = [](const json::JsonValue& answer) {
    for (const json::JsonValue& rule : answer.find("outcomes")->find("rules")->elements)
      if (rule.find("rule")->text == "tilt")
        return rule.find("value")->find("p95")->number - rule.find("value")->find("p05")->number;
    return -1.0;
  };
  EXPECT_LT(width_of_tilt(*mapped), 0.5);
  EXPECT_GT(width_of_tilt(*drawn), 1.0);
}

TEST(Relief, EveryFaultHasItsPlace) {
  EXPECT_EQ(kYard.faults_of(std::string(kFourMetres) + R"(,"relief":{})"),
            std::vector<std::string>{"/relief"})
      << "the yard states none";
  EXPECT_EQ(kYard.faults_of(std::string(kFourMetres) + R"(,"relief":{"rock_share":0.1,"max_rock_m":0.08})"),
            std::vector<std::string>{"/relief/max_rock_m"});
  EXPECT_EQ(kYard.faults_of(std::string(kFourMetres) + R"(,"relief":{"rock_share":2,"rocks":1})"),
            (std::vector<std::string>{"/relief/rock_share", "/relief/rocks"}));
}

TEST(Relief, TheRequestsValuesStandOverTheTerrains) {
  const ReliefValues terrain{.elevation_error_m = 0.3, .rock_share = 0.02};
  Legend legend;
  legend.classes = {{.value = 3, .label = "field", .soil = {}, .rock_share = 0.3}};
  const dem::GridGeometry geometry{
      .rows = 2, .columns = 2, .west_m = 0.0, .north_m = 2.0, .cell_x_m = 1.0, .cell_y_m = 1.0};
  const auto classes = std::make_shared<const dem::SoilMap>(
      geometry, std::vector<std::int16_t>{3, 3, 4, 4}, std::vector<std::uint8_t>{1, 1, 1, 0}, legend.classes);
  const auto drawn = relief_spread(terrain, {.elevation_error_m = 0.1}, legend, classes);
  EXPECT_EQ(drawn->elevation_error_m, 0.1);
  EXPECT_EQ(drawn->rock_share, 0.3) << "the most of any place";
  EXPECT_EQ(drawn->rock_share_at(0.5, 1.5), 0.3);
  EXPECT_EQ(drawn->rock_share_at(0.5, 0.5), 0.02) << "a class without a share has the terrain's";
  EXPECT_EQ(drawn->rock_share_at(1.5, 0.5), 0.02) << "so has ground without a class";
  EXPECT_FALSE(relief_spread(terrain, {.rock_share = 0.1}, legend, classes)->rock_share_at);
  EXPECT_EQ(relief_spread({}, {}, {}, nullptr), nullptr);
}

}  // namespace
}  // namespace slipway::api
