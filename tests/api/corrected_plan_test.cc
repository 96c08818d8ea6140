// Planning with a corrected model: what it stands in for, and what it changes.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "api/documents/plan_comparison.h"
#include "api/files/model_folder.h"
#include "api/json/parse.h"

namespace slipway::api {
namespace {

struct MadeRoute {
  double x_m = 0.0;
  double mean_slip = 0.1;
  const char* verdict = "go";
};

// Straight lines to the north, each at its own x.
std::string plan(const std::vector<MadeRoute>& routes) {
  std::string rows, features;
  for (std::size_t i = 0; i < routes.size(); ++i) {
    const std::string comma = i == 0 ? "" : ",", x = std::to_string(routes[i].x_m);
    rows += comma + R"({"rank":)" + std::to_string(i + 1) + R"(,"verdict":")" + routes[i].verdict +
            R"(","mean_slip":)" + std::to_string(routes[i].mean_slip) +
            R"(,"max_slip":{"value":0.2},"max_sinkage_m":{"value":0.01},"max_current_a":{"value":1},)" +
            R"("energy_wh":5,"risk":{"value":0}})";
    features.append(comma).append(R"({"geometry":{"coordinates":[[)").append(x).append(",0,0],[");
    features.append(x).append(",10,0]]}}");
  }
  return R"({"format":"plan/1","summary":[)" + rows + R"(],"routes":{"features":[)" + features + "]}}";
}

std::vector<std::vector<std::string>> changes(const std::string& nominal, const std::string& corrected) {
  const auto comparison = json::compare_plans(nominal, corrected);
  EXPECT_TRUE(comparison);
  std::vector<std::vector<std::string>> all;
  const auto document = json::parse(*comparison);
  for (const json::JsonValue& pair : document->find("routes")->elements) {
    all.emplace_back();
    for (const json::JsonValue& change : pair.find("changed")->elements) all.back().push_back(change.text);
  }
  return all;
}

using Changes = std::vector<std::vector<std::string>>;

TEST(PlanComparison, RoutesArePairedByWhereTheyLie) {
  const std::string before = plan({{0.0}, {20.0}});
  EXPECT_EQ(changes(before, before), (Changes{{}, {}}));
  EXPECT_EQ(changes(before, plan({{20.5}, {0.0, 0.2}})),
            (Changes{{"rank 2, was 1", "mean_slip 0.2, was 0.1"}, {"rank 1, was 2"}}));
  EXPECT_EQ(changes(before, plan({{3.0, 0.1, "no_go"}, {20.0}})),
            (Changes{{"verdict no_go, was go", "moved by 3.0 m on average"}, {}}));
}

TEST(PlanComparison, RoutesCanBeDroppedOrNew) {
  EXPECT_EQ(changes(plan({{0.0}, {20.0}}), plan({{20.0}})),
            (Changes{{"rank 1, was 2"}, {"no longer among the routes"}}));
  EXPECT_EQ(changes(plan({{20.0}}), plan({{20.0}, {0.0}})), (Changes{{}, {"a new route"}}));
  EXPECT_FALSE(json::compare_plans(plan({{0.0}}), R"({"format":"prediction/1"})"));
}

ModelFolder folder_of(const std::vector<std::string>& nominal_soils) {
  ModelFolder folder{"p", "rover", nominal_soils, {}};
  folder.model.rover.name = "rover-p-1";
  for (const std::string& soil : nominal_soils) {
    folder.model.soils.emplace_back();
    folder.model.soils.back().name = soil + "-p-1";
  }
  return folder;
}

TEST(CorrectedModel, StandsInForItsNominalSoilsAndForTheGroundThatIsNamed) {
  Catalogue catalogue;
  for (const char* const name : {"sand", "loam"}) catalogue.soils[name].name = name;
  const auto by_name = with_model(catalogue, folder_of({"sand"}), {});
  ASSERT_TRUE(by_name);
  EXPECT_EQ(by_name->soils.at("sand").name, "sand-p-1");
  EXPECT_EQ(by_name->soils.at("loam").name, "loam");
  EXPECT_TRUE(by_name->soils.contains("sand-p-1"));
  EXPECT_TRUE(by_name->rovers.contains("rover-p-1"));
  const auto by_ground = with_model(catalogue, folder_of({"nominal"}), {"loam"});
  ASSERT_TRUE(by_ground);
  EXPECT_EQ(by_ground->soils.at("loam").name, "nominal-p-1");
  EXPECT_EQ(by_ground->soils.at("sand").name, "sand");
}

TEST(CorrectedModel, GroundThatCannotBeToldIsRefusedWithItsPlace) {
  Catalogue catalogue;
  catalogue.soils["sand"].name = "sand";
  const auto refused = with_model(catalogue, folder_of({"a", "b"}), {"sand", "snad"});
  ASSERT_FALSE(refused);
  ASSERT_EQ(refused.error().faults.size(), 2U);
  EXPECT_EQ(refused.error().faults[0].pointer, "/ground/0");
  EXPECT_EQ(refused.error().faults[1].pointer, "/ground/1");
}

}  // namespace
}  // namespace slipway::api
