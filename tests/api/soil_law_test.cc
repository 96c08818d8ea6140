// A soil law, a soil field and a slip curve, from a file in a data folder to the answers.
#include <gtest/gtest.h>

#include <cmath>

#include "api/documents/catalogue_documents.h"
#include "api/documents/plan_answer.h"
#include "api/documents/plan_request.h"
#include "api/documents/prediction_answer.h"
#include "api/documents/prediction_request.h"
#include "api/documents/soil/wheel_sweep_answer.h"
#include "api/files/soil_file.h"
#include "api/json/parse.h"
#include "api/service.h"
#include "api/service_drives.h"
#include "api/wheel_sweep.h"
#include "tests/api/small_world.h"

namespace slipway::api {
namespace {

using testing::copy_small_world;
using testing::example;
using testing::file_bytes;
using testing::ScratchFolder;
using testing::small_world;
using testing::write_file;

// A data folder whose soil `name` (of mars_sites.json) is another one.
class WorldWithSoil {
 public:
  explicit WorldWithSoil(const std::string& soil, const sim::SoilFormat& format = sim::soil_format()) {
    copy_small_world(folder_.path());
    const auto file = folder_.path() / "soils" / "mars_sites.json";
    const auto soils = json::read_soil_file(file_bytes(file));
    json::Writer w;
    w.begin_object().text("format", "soils/1").key("soils").begin_array();
    for (const sim::SoilDistribution& kept : *soils)
      if (kept.name != "mer_b_sandy_loam") json::write_soil(w, kept);
    w.raw(soil).end_array().end_object();
    write_file(file, w.take());
    auto opened = Service::open({.data = folder_.path(), .threads = 2, .soil_format = &format});
    EXPECT_TRUE(opened) << (opened ? "" : opened.error().detail);
    service_ = std::move(*opened);
  }
  const Service& service() const { return *service_; }

 private:
  ScratchFolder folder_;
  std::unique_ptr<Service> service_;
};

// The shipped sandy loam with members of its own in place of k_c and k_phi, or beside them.
std::string sandy_loam(const std::string& members, bool with_bekker) {
  json::Writer w;
  json::write_soil(w, small_world().catalogue()->soils.at("mer_b_sandy_loam"));
  std::string text = w.take();
  if (!with_bekker) {
    const std::size_t from = text.find("\"k_c\""), to = text.find("\"n\"");
    text.erase(from, to - from);
  }
  return text.insert(1, members + ",");
}

const std::string kReece = R"("pressure_law":{"name":"reece","k_c":40,"k_phi":200})";

std::string sweep(const Service& service, const std::string& members) {
  const auto answer = run_wheel_sweep(
      *service.catalogue(), R"({"rover":"mer-class","soil":"mer_b_sandy_loam","slip":0.3)" + members + "}");
  EXPECT_TRUE(answer) << (answer ? "" : answer.error().faults.front().message);
  return answer ? json::write_wheel_sweep_answer(*answer) : "";
}

double first_of(const Service& service, const char* column, const std::string& members) {
  const auto document = json::parse(sweep(service, members));
  return document->find("rows")->elements.front().find(column)->number;
}

double pull_of(const Service& service, const std::string& members = "") {
  return first_of(service, "drawbar_pull_n", members);
}

double sinkage_of(const Service& service, const std::string& members = "") {
  return first_of(service, "sinkage_m", members);
}

Result<PredictionAnswer> predict(const Service& service, const std::string& request) {
  NoProgress progress;
  const auto read = read_prediction(service, request);
  if (!read) return fail(read.error());
  return run_prediction(service, *read, progress);
}

double mean_slip(const Service& service) {
  const auto answer = predict(service, example("prediction_path.json"));
  EXPECT_TRUE(answer) << (answer ? "" : answer.error().detail);
  return answer ? answer->prediction.mean_slip_ratio : 0.0;
}

TEST(SoilLaw, ReecesLawInASoilFileChangesTheWheelAndThePrediction) {
  const WorldWithSoil reece(sandy_loam(kReece, false));
  EXPECT_NE(pull_of(reece.service()), pull_of(small_world()));
  EXPECT_NE(mean_slip(reece.service()), mean_slip(small_world()));
  const std::string served = json::write_soils(*reece.service().catalogue());
  EXPECT_NE(served.find(kReece), std::string::npos);
  EXPECT_GT(sinkage_of(reece.service(), R"(,"set":{"soil.reece.k_phi":20})"), sinkage_of(reece.service()));
}

TEST(SoilLaw, WongsShearLawInASoilFileChangesTheWheel) {
  const WorldWithSoil wong(sandy_loam(R"("shear_law":{"name":"wong","residual_ratio":0.5})", true));
  EXPECT_NE(pull_of(wong.service()), pull_of(small_world()));
}

TEST(SoilLaw, TheDefaultLawsByNameLeaveTheSoilAsItWas) {
  const WorldWithSoil named(
      sandy_loam(R"("pressure_law":{"name":"bekker"},"shear_law":{"name":"janosi_hanamoto"})", true));
  EXPECT_EQ(sweep(named.service(), ""), sweep(small_world(), ""));
  EXPECT_EQ(json::write_soils(*named.service().catalogue()), json::write_soils(*small_world().catalogue()));
}

std::vector<std::string> faults_of_soil(const std::string& soil,
                                        const sim::SoilFormat& format = sim::soil_format()) {
  const auto read = json::read_soil_file(R"({"format":"soils/1","soils":[)" + soil + "]}", format);
  std::vector<std::string> pointers;
  if (!read)
    for (const Fault& fault : read.error().faults) pointers.push_back(fault.pointer);
  return pointers;
}

TEST(SoilLaw, EveryFaultOfAChoiceIsNamed) {
  using Pointers = std::vector<std::string>;
  EXPECT_EQ(faults_of_soil(sandy_loam(R"("pressure_law":{"name":"bernstein"})", true)),
            (Pointers{"/soils/0/pressure_law/name"}));
  EXPECT_EQ(
      faults_of_soil(sandy_loam(R"("pressure_law":{"name":"reece","k_c":-1e9,"m":1})", false)),
      (Pointers{"/soils/0/pressure_law/k_c", "/soils/0/pressure_law/k_phi", "/soils/0/pressure_law/m"}));
  // Bekker's moduli beside another law would be ignored.
  EXPECT_EQ(faults_of_soil(sandy_loam(kReece, true)), (Pointers{"/soils/0/k_c", "/soils/0/k_phi"}));
}

TEST(SoilLaw, WhatASoilHasNotIsNotSwept) {
  const WorldWithSoil reece(sandy_loam(kReece, false));
  const auto fault = [](const Service& service, const std::string& parameter) {
    const auto answer = read_wheel_sweep(
        *service.catalogue(), R"({"rover":"mer-class","soil":"mer_b_sandy_loam","sweep":[{"parameter":")" +
                                  parameter + R"(","values":[0.5]}]})");
    return answer ? "" : answer.error().faults.front().pointer;
  };
  EXPECT_EQ(fault(reece.service(), "soil.k_c"), "/sweep/0/parameter");
  EXPECT_EQ(fault(reece.service(), "soil.wong.residual_ratio"), "/sweep/0/parameter");
  EXPECT_EQ(fault(reece.service(), "soil.reece.k_c"), "");
  EXPECT_EQ(fault(small_world(), "soil.reece.k_c"), "/sweep/0/parameter");
}

// A law added as CONTRIBUTING says: a row, and its place in a catalogue. Pressure that saturates with depth
// [Kacigin & Guskov 1968], which is no power of it.
constexpr std::array kSaturatingFields{
    Field{"greatest_pa", "Pa", "the pressure that depth comes near", 1e3, 1e7, 1e5},
    Field{"depth_m", "m", "at which two thirds of it are there", 1e-3, 1.0, 0.02}};
const sim::PressureSinkageLaw kSaturating{
    .name = "saturating",
    .summary = "p = p_0 (1 - exp(-z / d))",
    .reference = "a test's",
    .fields = kSaturatingFields,
    .form =
        [](const sim::Soil& soil, const sim::ContactSize&) {
          const sim::LawParameters& p = soil.pressure_law.parameters;
          return sim::PressureForm{p[0] / std::pow(p[1], soil.pressure.n), 1.0};
        },
    .numbers = [](const sim::Soil& soil, const sim::ContactSize&) { return soil.pressure_law.parameters; },
    .pressure_pa = [](const sim::LawParameters& p, double,
                      double z) { return p[0] * (1.0 - std::exp(-z / p[1])); }};

TEST(SoilLaw, ALawOfATestsOwnActsFromTheSoilFileToTheWheelAndThePrediction) {
  std::vector<const sim::PressureSinkageLaw*> pressure(sim::soil_law_catalogue().pressure.begin(),
                                                       sim::soil_law_catalogue().pressure.end());
  pressure.push_back(&kSaturating);
  const sim::SoilFormat format{sim::soil_fields(), {pressure, sim::soil_law_catalogue().shear}};
  const std::string soft = R"("pressure_law":{"name":"saturating","greatest_pa":20000,"depth_m":0.02})";
  const std::string firm = R"("pressure_law":{"name":"saturating","greatest_pa":200000,"depth_m":0.02})";
  const WorldWithSoil on_soft(sandy_loam(soft, false), format), on_firm(sandy_loam(firm, false), format);
  EXPECT_GT(sinkage_of(on_soft.service()), sinkage_of(on_firm.service()));
  EXPECT_NE(mean_slip(on_soft.service()), mean_slip(on_firm.service()));
  EXPECT_NEAR(pull_of(on_soft.service(), R"(,"set":{"soil.saturating.greatest_pa":200000})"),
              pull_of(on_firm.service()), 1e-9);
  EXPECT_NE(json::write_soils(*on_soft.service().catalogue()).find(soft), std::string::npos);
  EXPECT_EQ(faults_of_soil(sandy_loam(soft, false)), (std::vector<std::string>{"/soils/0/pressure_law/name"}))
      << "without its row it is unknown";
}

// A field added as CONTRIBUTING says: a row with key, unit, range and member.
TEST(SoilField, AFieldOfATestsOwnIsReadSweptAndWrittenBack) {
  std::vector<sim::SoilField> fields(sim::soil_fields().begin(), sim::soil_fields().end());
  fields.push_back(
      {.field = {"front_bulldozing", "1", "share of the passive pressure on the front", 0.0, 2.0, 0.0},
       .number = [](sim::Soil& s) -> double& { return s.bulldozing; },
       .presence = FieldPresence::kOptional});
  const sim::SoilFormat format{fields, sim::soil_law_catalogue()};
  const WorldWithSoil pushed(sandy_loam(R"("front_bulldozing":1.5)", true), format);
  EXPECT_LT(pull_of(pushed.service()), pull_of(small_world()));
  EXPECT_NEAR(pull_of(pushed.service(), R"(,"set":{"soil.front_bulldozing":0})"), pull_of(small_world()),
              1e-9);
  EXPECT_NE(json::write_soils(*pushed.service().catalogue()).find(R"("front_bulldozing":1.5)"),
            std::string::npos);
  EXPECT_EQ(faults_of_soil(sandy_loam(R"("front_bulldozing":3)", true), format),
            (std::vector<std::string>{"/soils/0/front_bulldozing"}));
  const auto columns =
      sweep(pushed.service(), R"(,"sweep":[{"parameter":"soil.front_bulldozing","values":[0,1]}])");
  EXPECT_NE(columns.find("share of the passive pressure on the front"), std::string::npos);
}

std::string tabulated(double slip_at_ten) {
  return R"({"name":"mer_b_sandy_loam","summary":"s","source":"t","assumed":["side_slip_deg"],"slip_curve":{)"
         R"("slope_deg":[-30,0,10,30],"slip":[-0.05,0.05,)" +
         std::to_string(slip_at_ten) +
         R"(,0.9],"cross_slope_deg":[0,30],"side_slip_deg":[0,15]},"std":{"slip_ratio":0.05},"correlation_length_m":5})";
}

TEST(SlipCurveSoil, IsServedAsItsFileAndItsFaultsAreNamed) {
  const auto read = json::read_soil_file(R"({"format":"soils/1","soils":[)" + tabulated(0.25) + "]}");
  ASSERT_TRUE(read) << read.error().faults.front().message;
  json::Writer w;
  json::write_soil(w, read->front());
  const std::string served = w.take();
  const auto again = json::read_soil_file(R"({"format":"soils/1","soils":[)" + served + "]}");
  ASSERT_TRUE(again);
  json::Writer w2;
  json::write_soil(w2, again->front());
  EXPECT_EQ(w2.take(), served);
  std::string bad = tabulated(0.25);
  bad.replace(bad.find("[-30,0,"), 7, "[30,0,");
  bad.insert(1, R"("n":1.0,)");
  EXPECT_EQ(faults_of_soil(bad), (std::vector<std::string>{"/soils/0/slip_curve/slope_deg",
                                                           "/soils/0/slip_curve/slope_deg", "/soils/0/n"}));
}

TEST(SlipCurveSoil, APredictionHasItsSlipAndNoFiguresOfWheels) {
  const WorldWithSoil curve(tabulated(0.25));
  const auto answer = predict(curve.service(), example("prediction_path.json"));
  ASSERT_TRUE(answer) << answer.error().detail;
  const auto document = json::parse(json::write_prediction_answer(*answer));
  ASSERT_TRUE(document);
  const std::string text = json::write_prediction_answer(*answer);
  EXPECT_NE(text.find(R"("energy_wh":null)"), std::string::npos);
  EXPECT_NE(text.find(R"("max_sinkage_m":null)"), std::string::npos);
  EXPECT_NE(text.find(R"("slip_curve_length_m":)"), std::string::npos);
  const WorldWithSoil slippery(tabulated(0.6));
  EXPECT_GT(mean_slip(slippery.service()), answer->prediction.mean_slip_ratio);
}

TEST(SlipCurveSoil, APlanDrivesOverItAndItsSlipCounts) {
  NoProgress progress;
  const auto plan_on = [&](const Service& service) {
    const auto request = read_plan(service, example("plan_shortest.json"));
    EXPECT_TRUE(request) << (request ? "" : request.error().detail);
    return run_plan(service, *request, progress);
  };
  const WorldWithSoil easy(tabulated(0.1)), hard(tabulated(0.5));
  const auto on_easy = plan_on(easy.service()), on_hard = plan_on(hard.service());
  ASSERT_TRUE(on_easy && on_hard);
  ASSERT_FALSE(on_easy->plan.routes.empty() || on_hard->plan.routes.empty());
  EXPECT_LE(on_easy->plan.routes.front().prediction.mean_slip_ratio,
            on_hard->plan.routes.front().prediction.mean_slip_ratio);
  EXPECT_TRUE(on_easy->plan.routes.front().prediction.by_slip_curve);
}

TEST(SlipCurveSoil, WhatNeedsForcesIsRefusedWithAReason) {
  const WorldWithSoil curve(tabulated(0.25));
  const auto wheel =
      read_wheel_sweep(*curve.service().catalogue(), R"({"rover":"mer-class","soil":"mer_b_sandy_loam"})");
  ASSERT_FALSE(wheel);
  EXPECT_EQ(wheel.error().faults.front().pointer, "/soil");
  EXPECT_NE(wheel.error().faults.front().message.find("slip curve"), std::string::npos);
  const auto dynamic = predict(curve.service(), example("prediction_dynamic.json"));
  ASSERT_TRUE(dynamic) << dynamic.error().detail;
  ASSERT_TRUE(dynamic->dynamic);
  EXPECT_FALSE(dynamic->dynamic->end);
  EXPECT_NE(dynamic->dynamic->reason.find("slip curve"), std::string::npos) << dynamic->dynamic->reason;
}

}  // namespace
}  // namespace slipway::api
