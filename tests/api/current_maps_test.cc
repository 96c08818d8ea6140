#include "api/requests/current_maps.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "api/documents/soil/current_documents.h"
#include "api/json/parse.h"
#include "api/report/current_maps_output.h"
#include "api/requests/current_inversion.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using testing::small_world;

const Catalogue& catalogue() {
  return *small_world().catalogue();
}

std::vector<std::string> pointers_of(const Error& error) {
  std::vector<std::string> pointers;
  for (const Fault& fault : error.faults) pointers.push_back(fault.pointer);
  return pointers;
}

TEST(CurrentFigure, HasThePanelsOfThePaper) {
  const std::map<int, std::pair<std::size_t, std::size_t>> panels_and_points{
      {9, {9, 9 * 46}}, {10, {6, 3 * 61 * (4 + 5)}}, {11, {6, 3 * 61 * (5 + 5)}}};
  for (const auto& [figure, counts] : panels_and_points) {
    const auto maps = current_figure(catalogue(), {}, figure);
    ASSERT_TRUE(maps) << maps.error().detail;
    EXPECT_EQ(maps->panels.size(), counts.first);
    const std::string csv = current_maps_csv(*maps);
    EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), 1 + counts.second);
    EXPECT_TRUE(
        csv.starts_with("panel,soil,model,slip,load_n,k_s,n,cohesion_pa,friction_angle_deg,shear_modulus_x_m,"
                        "current_a,sinkage_m,torque_nm,reason\n"));
    EXPECT_EQ(csv.find("nan"), std::string::npos);
    EXPECT_TRUE(json::parse(json::write_current_maps(*maps), {.bytes = 10'000'000, .values = 10'000'000}));
    EXPECT_EQ(csv, current_maps_csv(current_figure(catalogue(), {}, figure).value()));
    EXPECT_EQ(draw_current_maps(*maps), draw_current_maps(*maps));
  }
}

TEST(CurrentFigure, TheCurrentThatThePaperPrintsIsInFigureNine) {
  const auto maps = current_figure(catalogue(), {}, 9).value();
  const auto dense = std::find_if(maps.panels.begin(), maps.panels.end(),
                                  [](const CurrentPanel& p) { return p.soil == "jlu_mars_2_dense"; });
  ASSERT_NE(dense, maps.panels.end());
  EXPECT_EQ(dense->points.at(0).place.at, std::vector<double>{0.0});
  EXPECT_NEAR(*dense->points.at(0).current_a, 0.114, 5e-4);
}

TEST(CurrentFigure, KeepsShearOrPressureParametersOfTheSimulant) {
  const auto shear = current_figure(catalogue(), {}, 10).value();
  const sim::Soil& loose = catalogue().soils.find("jlu_mars_3_loose")->second.mean;
  for (const sim::CurrentPoint& point : shear.panels.at(4).points) {
    EXPECT_EQ(point.place.test.soil.cohesion_pa, loose.cohesion_pa);
    EXPECT_EQ(point.place.test.slip, 0.1);
  }
  const auto pressure = current_figure(catalogue(), {}, 11).value();
  for (const sim::CurrentPoint& point : pressure.panels.at(5).points)
    EXPECT_EQ(point.place.test.soil.pressure.k_phi, loose.pressure.k_phi);
}

TEST(CurrentMapRequest, FaultsAreNamed) {
  EXPECT_EQ(pointers_of(current_figure(catalogue(), {}, 12).error()), std::vector<std::string>{"/figure"});
  CurrentMapOptions options;
  options.rover = "zhurong";
  EXPECT_EQ(pointers_of(current_map(catalogue(), options, "sand", {{"slip", {0.1}}}).error()),
            (std::vector<std::string>{"/rover", "/soil"}));
  options = {};
  options.slip = 3.0;
  options.load_n = -1.0;
  EXPECT_EQ(pointers_of(current_map(catalogue(), options, "mpf_drift", {{"soil.n", {1.0}}}).error()),
            (std::vector<std::string>{"/slip", "/load_n"}));
  EXPECT_EQ(pointers_of(current_map(catalogue(), {}, "mpf_drift", {{"soil.m", {1.0}}}).error()),
            (std::vector<std::string>{"/sweep/0/parameter"}));
}

TEST(CurrentMapCsv, AnAxisThatIsNoColumnGetsOne) {
  const auto maps = current_map(catalogue(), {}, "mpf_drift", {{"soil.c1", {0.2, 0.4}}, {"slip", {0.1}}});
  ASSERT_TRUE(maps);
  const std::string csv = current_maps_csv(*maps);
  EXPECT_TRUE(csv.starts_with("panel,soil,model,soil.c1,slip,"));
  EXPECT_NE(csv.find("map,mpf_drift,literal,0.4,0.1,"), std::string::npos) << csv;
}

TEST(CurrentInversion, GivesTheSlipOfABalancedMapsCurrent) {
  CurrentMapOptions options;
  options.model = sim::CurrentModel::kBalanced;
  const auto map = current_map(catalogue(), options, "jlu_mars_3_medium", {{"slip", {0.33}}});
  ASSERT_TRUE(map);
  CurrentInversionRequest request;
  request.rover = "zhurong-class";
  request.soil = "jlu_mars_3_medium";
  request.gravity_m_s2 = 9.81;
  request.current_a = *map->panels[0].points[0].current_a;
  const auto inversion = invert_current(catalogue(), request);
  ASSERT_TRUE(inversion) << inversion.error().detail;
  EXPECT_NEAR(*inversion->answer.found.reported, 0.33, 1e-9);
  EXPECT_EQ(json::write_current_inversion(*inversion),
            json::write_current_inversion(invert_current(catalogue(), request).value()));
}

TEST(CurrentInversion, EffectsAreAtWorkOnTheDrawsToo) {
  CurrentInversionRequest request;
  request.rover = "mer-class";
  request.soil = "mpf_drift";
  request.current_a = 0.2;
  request.options.draws = 20;
  const auto plain = invert_current(catalogue(), request).value();
  request.effects = {{.name = "bulldozing", .parameters = {}},
                     {.name = "slip_sinkage", .parameters = {{"n1", 0.5}}}};
  const auto sinking = invert_current(catalogue(), request).value();
  ASSERT_TRUE(plain.answer.found.reported && sinking.answer.found.reported);
  EXPECT_NE(*plain.answer.found.reported, *sinking.answer.found.reported);
  EXPECT_NE(plain.answer.quantiles.p50, sinking.answer.quantiles.p50);
}

TEST(CurrentInversion, FaultsAreNamedTogether) {
  CurrentInversionRequest request;
  request.rover = "mer-class";
  request.wheel = "xx";
  request.soil = "sand";
  request.load_n = 0.0;
  request.options.draws = 0;
  request.effects = {{.name = "gravel", .parameters = {}}};
  EXPECT_EQ(pointers_of(invert_current(catalogue(), request).error()),
            (std::vector<std::string>{"/effects/0/name", "/draws", "/load_n", "/wheel", "/soil"}));
}

}  // namespace
}  // namespace slipway::api
