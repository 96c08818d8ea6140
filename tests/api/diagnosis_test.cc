// What is made of a diagnosis: its document, its corrected model, its report. The diagnosis itself is made
// up.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string>

#include "api/documents/catalogue_documents.h"
#include "api/documents/diagnosis/diagnosis_document.h"
#include "api/files/corrected_model.h"
#include "api/files/rover_file.h"
#include "api/files/soil_file.h"
#include "api/job_kinds.h"
#include "api/json/parse.h"
#include "api/json/text_place.h"
#include "api/report/diagnosis_charts.h"
#include "api/report/diagnosis_report.h"
#include "api/service_diagnoses.h"
#include "made_diagnosis.h"
#include "sim/effects/effect_catalogue.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using json::JsonValue;

class ADiagnosis : public testing::WithFullDiagnosis {
 protected:
  static JsonValue document(const gap::Diagnosis& d) {
    return json::parse(json::diagnosis_document(campaign(), d)).value();
  }
};

TEST_F(ADiagnosis, HasEveryKeyOfItsContract) {
  const JsonValue d = document(diagnosis());
  for (const char* key : {"format", "campaign", "provenance", "verdict", "effects", "marginals", "candidates",
                          "confusable", "look_alikes", "measurements", "where", "gap", "residual",
                          "next_drives", "model", "notes", "least_detectable"})
    EXPECT_NE(d.find(key), nullptr) << key;
  for (const char* key : {"channels", "regimes", "places", "windows"})
    EXPECT_NE(d.find("where")->find(key), nullptr) << key;
  // As the format says, of every channel and of all.
  const JsonValue& gap = *d.find("gap");
  for (const JsonValue* at : {&gap, &gap.find("channels")->elements.at(0)}) {
    ASSERT_NE(at->find("closed_fraction"), nullptr);
    EXPECT_EQ(at->find("closed_fraction")->find("interval_90")->elements.size(), 2U);
  }
  EXPECT_EQ(d.find("format")->text, "diagnosis/1");
  EXPECT_EQ(d.find("provenance")->find("hashes")->find("campaign")->text, campaign().fingerprint);
}

TEST_F(ADiagnosis, SaysWhichOptionsItWasMadeWith) {
  const JsonValue d = document(diagnosis());
  const JsonValue& options = *d.find("provenance")->find("options");
  EXPECT_EQ(options.find("fit")->find("huber")->number, gap::FitOptions{}.huber);
  EXPECT_EQ(options.find("evidence")->find("share")->number, gap::EvidenceOptions{}.share);
  EXPECT_EQ(options.find("run")->find("resamples")->number, gap::DiagnosisOptions{}.resamples);
}

TEST_F(ADiagnosis, GivesEverySetOnceWithProbabilitiesThatAddUpToOne) {
  for (const bool empty : {false, true}) {
    const JsonValue d = document(empty ? gap::Diagnosis{} : diagnosis());
    double sum = 0.0, last = 1.0;
    std::set<std::set<std::string>> sets;
    for (const JsonValue& candidate : d.find("candidates")->elements) {
      std::set<std::string> names;
      for (const JsonValue& name : candidate.find("effects")->elements) names.insert(name.text);
      EXPECT_TRUE(sets.insert(names).second);
      EXPECT_LE(candidate.find("probability")->number, last);
      last = candidate.find("probability")->number;
      sum += last;
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_TRUE(sets.contains({}));
    EXPECT_TRUE(sets.contains({"unknown"}));
    EXPECT_EQ(sets.size(), empty ? 2U : 5U);
  }
}

TEST_F(ADiagnosis, TellsTheFormOfWhatIsLeftAndEachEffectsMarginal) {
  const JsonValue d = document(diagnosis());
  const JsonValue& grousers = d.find("marginals")->elements.at(0);
  EXPECT_EQ(grousers.find("name")->text, "grousers");
  EXPECT_EQ(grousers.find("probability")->number, 0.97);
  EXPECT_EQ(grousers.find("closed_share")->number, 0.8);
  EXPECT_EQ(d.find("residual")->elements.at(0).find("form")->text, "smooth_function");
  const JsonValue& pull = d.find("residual")->elements.at(1);
  EXPECT_EQ(pull.find("form")->text, "force_on_body");
  EXPECT_EQ(pull.find("text")->text, "a steady pull of 25 N against the travel, at the body");
  EXPECT_EQ(pull.find("parameters")->find("force_n")->find("interval_90")->elements.at(1).number, -23.0);
  const JsonValue& measurement = d.find("measurements")->elements.at(0);
  EXPECT_EQ(measurement.find("effect")->text, "hardpan");
  EXPECT_EQ(measurement.find("measure")->elements.at(0).text, "plate and shear tests of the soil");
  EXPECT_EQ(measurement.find("parameters")->elements.at(2).text, "c1");
  EXPECT_EQ(measurement.find("deviations_then")->number, 7.5);
  EXPECT_EQ(d.find("candidates")->elements.at(0).find("log_evidence")->number, 12.5);
  EXPECT_EQ(d.find("candidates")->elements.at(1).find("log_evidence"), nullptr) << "it was not compared";
  EXPECT_EQ(d.find("look_alikes")->elements.at(0).find("like")->text, "parameters");
  const std::string report = diagnosis_report(campaign(), diagnosis(), {}).markdown();
  EXPECT_NE(report.find("| grousers | 0.970 | 80 % |"), std::string::npos) << "its marginal";
}

// Nominal, re-tuned, with effects, with what nobody has named described, floor: in degrees.
TEST_F(ADiagnosis, ShowsEveryRungOfTheLadder) {
  const JsonValue d = document(diagnosis());
  const JsonValue& pitch = d.find("gap")->find("channels")->elements[0];
  EXPECT_NEAR(pitch.find("with_discrepancy")->find("value")->number, 0.544310, 1e-5);
  const std::string report = diagnosis_report(campaign(), diagnosis(), {}).markdown();
  EXPECT_NE(report.find("| channel | unit | nominal | re-tuned | with effects | with discrepancy | floor |"),
            std::string::npos);
  EXPECT_NE(report.find("0.573 (0 to 1.15) | 0.544 (0 to 0.859) | 0.573 |"), std::string::npos) << report;
  gap::Diagnosis earlier = diagnosis();
  earlier.gap.front().with_discrepancy.reset();
  EXPECT_EQ(document(earlier).find("gap")->find("channels")->elements[0].find("with_discrepancy"), nullptr);
  EXPECT_EQ(diagnosis_report(campaign(), earlier, {}).markdown().find("| with discrepancy |"),
            std::string::npos);
}

TEST_F(ADiagnosis, TellsWhatTheReferenceTaught) {
  const JsonValue d = document(diagnosis());
  const JsonValue& reference = *d.find("reference");
  EXPECT_EQ(reference.find("campaign")->text, "last_year");
  EXPECT_EQ(reference.find("drives")->number, 20.0);
  EXPECT_NEAR(reference.find("discrepancy")->elements.at(0).find("learnt")->number, 0.687549, 1e-5);
  const std::string report = diagnosis_report(campaign(), diagnosis(), {}).markdown();
  EXPECT_NE(report.find("## What has changed since the reference"), std::string::npos);
  EXPECT_NE(report.find("20 drives of last_year (80 windows) were taken as healthy"), std::string::npos);
  EXPECT_NE(report.find("| pitch | deg | 0.688 | 0.115 |"), std::string::npos) << report;
  gap::Diagnosis alone = diagnosis();
  alone.reference.reset();
  EXPECT_EQ(document(alone).find("reference"), nullptr);
  EXPECT_EQ(diagnosis_report(campaign(), alone, {}).markdown().find("since the reference"),
            std::string::npos);
}

TEST_F(ADiagnosis, IsInTheUnitsOfTheBoundary) {
  const JsonValue d = document(diagnosis());
  const JsonValue& pitch = d.find("gap")->find("channels")->elements[0];
  EXPECT_EQ(pitch.find("unit")->text, "deg");
  EXPECT_NEAR(pitch.find("nominal")->find("value")->number, 1.71887, 1e-4);
  EXPECT_NEAR(pitch.find("nominal")->find("interval_90")->elements[1].number, 2.29183, 1e-4);
  const JsonValue& yaw = d.find("where")->find("channels")->elements[0];
  EXPECT_NEAR(yaw.find("gap")->number, 0.572958, 1e-5);
}

TEST_F(ADiagnosis, LeavesOutWhatIsNotFinite) {
  const JsonValue d = document(diagnosis());
  EXPECT_EQ(d.find("least_detectable")->elements.size(), 1U);
  EXPECT_EQ(d.find("where")->find("regimes")->elements[0].find("condition")->elements[0].find("to"), nullptr);
  EXPECT_EQ(d.find("where")->find("channels")->elements[1].find("noise"), nullptr);
  EXPECT_EQ(d.find("residual")->elements[0].find("shape")->elements.size(), 1U);
}

TEST_F(ADiagnosis, GivesPlacesAsClosedPolygons) {
  const JsonValue d = document(diagnosis());
  const JsonValue& ring = d.find("where")
                              ->find("places")
                              ->find("features")
                              ->elements.at(0)
                              .find("geometry")
                              ->find("coordinates")
                              ->elements.at(0);
  ASSERT_EQ(ring.elements.size(), 33U);
  EXPECT_EQ(ring.elements.front().elements[0].number, ring.elements.back().elements[0].number);
  EXPECT_EQ(ring.elements.front().elements[0].number, 4.5);
}

TEST_F(ADiagnosis, OffersTheModelThatWasFitted) {
  auto model = corrected_model(campaign(), diagnosis());
  ASSERT_TRUE(model);
  sim::RoverModel driven = model->rover;
  sim::apply_effects(driven.effects, driven);
  const sim::RoverModel& fitted = diagnosis().model->rover;
  EXPECT_EQ(driven.drive.torque_constant_nm_per_a, fitted.drive.torque_constant_nm_per_a);
  EXPECT_EQ(driven.drive.torque_constant_per_k, fitted.drive.torque_constant_per_k);
  EXPECT_GT(driven.drive.torque_constant_per_k, 0.0);
  EXPECT_EQ(driven.pull_below_axle, fitted.pull_below_axle);
  sim::Soil soil = model->soils.at(0).mean;
  sim::apply_effects(driven.effects, soil);
  const sim::Soil& fitted_soil = diagnosis().model->soils.at(0);
  EXPECT_EQ(soil.pressure.k_phi, fitted_soil.pressure.k_phi);
  EXPECT_EQ(soil.friction_angle_rad, fitted_soil.friction_angle_rad);
  EXPECT_EQ(soil.shear_modulus_y_m, fitted_soil.shear_modulus_y_m);
  EXPECT_EQ(soil.n1, fitted_soil.n1);
  EXPECT_EQ(soil.c2, fitted_soil.c2);
  EXPECT_EQ(soil.exit_angle_ratio, fitted_soil.exit_angle_ratio);
}

// With a reference soils of the same name are the reference's, on which the fit was made: the campaign's own
// numbers of them, re-tuned, would be a soil that nobody fitted.
TEST_F(ADiagnosis, OffersTheSoilsThatItsParametersAreRelativeTo) {
  gap::Diagnosis since = diagnosis();
  since.nominal_soils.front().soil.cohesion_pa *= 3.0;
  auto rover = std::make_shared<sim::RoverModel>(*since.nominal_rover);
  rover->drive.torque_constant_nm_per_a *= 2.0;
  since.nominal_rover = rover;
  const auto own = corrected_model(campaign(), diagnosis()), model = corrected_model(campaign(), since);
  ASSERT_TRUE(own && model);
  EXPECT_DOUBLE_EQ(model->soils.front().mean.cohesion_pa, 3.0 * own->soils.front().mean.cohesion_pa);
  EXPECT_DOUBLE_EQ(model->rover.drive.torque_constant_nm_per_a,
                   2.0 * own->rover.drive.torque_constant_nm_per_a);
}

TEST_F(ADiagnosis, OffersFilesThatAreReadAsTheyWereWritten) {
  const auto model = corrected_model(campaign(), diagnosis());
  ASSERT_TRUE(model);
  EXPECT_TRUE(model->rover.name.starts_with("mer-class-p05-")) << model->rover.name;
  const std::string rover = json::rover_document(*model);
  const auto read = json::read_rover_file(rover);
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_EQ(json::rover_document({*read, {}, {}, {}, {}}), rover);
  const std::string soils = json::soils_document(*model);
  const auto soils_read = json::read_soil_file(soils);
  ASSERT_TRUE(soils_read) << soils_read.error().detail;
  EXPECT_EQ(json::soils_document({{}, *soils_read, {}, {}, {}}), soils);
  EXPECT_TRUE(soils_read->front().name.starts_with("nominal-p05-"));
  EXPECT_GT(soils_read->front().std.stiffness_ratio, 0.0);
}

// Stiffness and exponent pull against each other in every fit: a soil that is drawn has both off together.
TEST_F(ADiagnosis, OffersSoilsWhoseParametersErrTogether) {
  const auto model = corrected_model(campaign(), diagnosis());
  ASSERT_TRUE(model);
  const sim::SoilDistribution& soil = model->soils.at(0);
  const gap::ParameterPosterior& open = diagnosis().left_open;
  const auto k = open.place_of("stiffness", soil.name), n = open.place_of("n", soil.name);
  ASSERT_TRUE(k && n);
  EXPECT_NEAR(soil.std.stiffness_ratio, std::hypot(open.deviation(*k), diagnosis().noise.stiffness), 1e-12);
  EXPECT_NEAR(soil.correlation(0, 1), -0.5 * open.deviation(*k) / soil.std.stiffness_ratio, 1e-12);
  EXPECT_EQ(soil.correlation(0, 1), soil.correlation(1, 0));
  EXPECT_EQ(soil.correlation(0, 2), 0.0);
}

TEST_F(ADiagnosis, OffersAnotherVersionOfOtherNumbersAndNoneWhereNoneWasFound) {
  gap::Diagnosis other = diagnosis();
  other.retuned.front().value.value += 0.01;
  EXPECT_NE(corrected_model(campaign(), other)->rover.name,
            corrected_model(campaign(), diagnosis())->rover.name);
  other.model.reset();
  EXPECT_FALSE(corrected_model(campaign(), other));
  EXPECT_EQ(document(other).find("model"), nullptr);
}

TEST_F(ADiagnosis, IsReportedWithItsPictures) {
  const auto charts = draw_diagnosis(campaign(), diagnosis());
  const std::string report = diagnosis_report(campaign(), diagnosis(), charts).markdown();
  EXPECT_EQ(charts.size(), 7U);
  for (const NamedChart& chart : charts)
    EXPECT_NE(report.find("(" + chart.name + ".svg)"), std::string::npos) << chart.name;
  for (const char* words :
       {"**effects**", "motor_temperature", "a \\| note of two lines", "0.9 (0.7 to 1.1)"})
    EXPECT_NE(report.find(words), std::string::npos) << words;
  EXPECT_EQ(report.find("nan"), std::string::npos);
  EXPECT_EQ(report,
            diagnosis_report(campaign(), diagnosis(), draw_diagnosis(campaign(), diagnosis())).markdown());
  // Nothing at all is a report, too.
  EXPECT_NE(diagnosis_report(campaign(), {}, {}).markdown().find("**insufficient**"), std::string::npos);
}

TEST_F(ADiagnosis, IsShownAsOnePageThatHoldsItsPicturesAndLoadsNothing) {
  const auto charts = draw_diagnosis(campaign(), diagnosis());
  const std::string page = diagnosis_report(campaign(), diagnosis(), charts).html();
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
  std::set<std::string> ids;
  for (std::size_t at = page.find(" id=\""); at != std::string::npos; at = page.find(" id=\"", at + 1))
    EXPECT_TRUE(ids.insert(page.substr(at, page.find('"', at + 5) - at)).second) << page.substr(at, 40);
  for (const NamedChart& chart : charts) EXPECT_TRUE(ids.contains(" id=\"" + chart.name)) << chart.name;
  for (const char* outside : {"<script", "src=", "@import", "<link", "href=\"http", "url(http", "nan"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  EXPECT_NE(page.find("Content-Security-Policy"), std::string::npos);
  // The same words as in Markdown.
  EXPECT_NE(page.find("<strong>effects</strong>"), std::string::npos);
  EXPECT_NE(page.find("0.9 (0.7 to 1.1)"), std::string::npos);
}

TEST_F(ADiagnosis, IsShownWithAllItsTextEscaped) {
  gap::Diagnosis d = diagnosis();
  const std::string bad = "<script>alert(\"1\")</script> & 'x' id=\"a";
  d.campaign = d.reason = d.overturned_by = bad;
  d.notes = {bad};
  d.effects.front().name = d.effects.front().variant = bad;
  d.candidates.front().effects = {bad};
  d.confusable.front().a = bad;
  d.channels.back().wheel = bad;
  d.retuned.front().name = bad;
  d.places.front().terrain = bad;
  const std::string page = diagnosis_report(campaign(), d, draw_diagnosis(campaign(), d)).html();
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find(" id=\"a"), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt; &amp; &#39;x&#39;"),
            std::string::npos);
}

TEST_F(ADiagnosis, IsMappedWithItsWindowsOverTheGround) {
  const auto charts = draw_diagnosis(campaign(), diagnosis());
  const auto map = std::find_if(charts.begin(), charts.end(), [](const auto& c) { return c.name == "map"; });
  ASSERT_NE(map, charts.end());
  const std::string terrain = campaign().terrains.front().name;
  for (const std::string& words : {terrain + ", nominal", terrain + ", re-tuned", terrain + ", with effects",
                                   std::string("data:image/png;base64,"), std::string("above 4 deviations")})
    EXPECT_NE(map->svg.find(words), std::string::npos) << words;
  const JsonValue d = document(diagnosis());
  const JsonValue& window = d.find("where")->find("windows")->elements.at(0);
  EXPECT_EQ(window.find("terrain")->text, terrain);
  EXPECT_EQ(window.find("drive")->text, campaign().drives.front().id);
  EXPECT_EQ(window.find("x_m")->number, 3.5);
  EXPECT_EQ(window.find("nominal")->number, 4.5);
  EXPECT_EQ(window.find("with_effects"), nullptr);
  ASSERT_EQ(window.find("values")->elements.size(), 1U);
  const JsonValue& slip = window.find("values")->elements[0];
  EXPECT_EQ(slip.find("channel")->text, "slip");
  EXPECT_EQ(slip.find("unit")->text, "1");
  EXPECT_EQ(slip.find("measured")->number, 0.1);
  EXPECT_EQ(slip.find("nominal")->number, 0.2);
  EXPECT_EQ(slip.find("retuned")->number, 0.15);
  EXPECT_EQ(slip.find("with_effects"), nullptr) << "no effect was fitted";
}

TEST(KeptAnswer, IsADocumentAndAPage) {
  EXPECT_EQ(parts_of("{}").document, "{}");
  EXPECT_EQ(parts_of("{}").page, "");
  EXPECT_EQ(parts_of("{}\n<!DOCTYPE html>\n<p>").document, "{}");
  EXPECT_EQ(parts_of("{}\n<!DOCTYPE html>\n<p>").page, "<!DOCTYPE html>\n<p>");
}

TEST(TextPlace, IsLineAndColumnOfAPointersValue) {
  const std::string text = "{\n \"a\": [1, {\"b/c\": \"]\\\"}\", \"d\": 2}],\n\t\"e\" : null}\n";
  const auto at = [&](std::string_view pointer) {
    const json::TextPlace place = json::place_of(text, pointer);
    return std::pair(place.line, place.column);
  };
  using Place = std::pair<std::size_t, std::size_t>;
  EXPECT_EQ(at(""), Place(1, 1));
  EXPECT_EQ(at("/a"), Place(2, 7));
  EXPECT_EQ(at("/a/1/b~1c"), Place(2, 19));
  EXPECT_EQ(at("/a/1/d"), Place(2, 32));
  EXPECT_EQ(at("/e"), Place(3, 8));
  EXPECT_EQ(at("/a/1/nothing"), Place(2, 11));
  EXPECT_EQ(at("/e/below"), Place(3, 8));
  for (std::size_t cut = 0; cut < text.size(); ++cut) json::place_of(text.substr(0, cut), "/a/1/d/x");
}

TEST(DriveCampaigns, AreListedAsRequestsNameThem) {
  const auto service = Service::open({.data = SLIPWAY_DATA_FOLDER});
  ASSERT_TRUE(service);
  const JsonValue list = json::parse(json::write_drive_campaigns((*service)->campaigns())).value();
  ASSERT_FALSE(list.find("campaigns")->elements.empty());
  for (const JsonValue& campaign : list.find("campaigns")->elements) {
    const std::string& name = campaign.find("name")->text;
    EXPECT_TRUE(read_diagnosis(**service, "{\"campaign\":\"" + name + "\"}")) << name;
    if (name != "p05") continue;
    EXPECT_EQ(campaign.find("rover")->text, "mer-class");
    EXPECT_EQ(campaign.find("drives")->elements.size(), 44U);
    EXPECT_EQ(campaign.find("terrains")->elements.size(), 5U);
    EXPECT_EQ(campaign.find("drives")->elements.at(0).find("terrain")->text, "tilt_00");
  }
  EXPECT_TRUE(testing::small_world().campaigns().empty());
}

TEST(DiagnosisRequest, IsOfDrivesThatShip) {
  const auto request = read_diagnosis(testing::small_world(), R"({"campaign":"p05"})");
  ASSERT_FALSE(request);
  EXPECT_EQ(request.error().faults.at(0).pointer, "/campaign");
  const auto service = Service::open({.data = SLIPWAY_DATA_FOLDER});
  ASSERT_TRUE(service);
  EXPECT_TRUE(read_diagnosis(**service, testing::example("diagnosis_practice.json")));
  for (const char* campaign : {"../gap-practice/p05", "/etc", ".", "p99", ""})
    EXPECT_FALSE(read_diagnosis(**service, "{\"campaign\":\"" + std::string(campaign) + "\"}")) << campaign;
}

TEST(DiagnosisRequest, MayNameOtherDrivesAsItsReference) {
  const auto service = Service::open({.data = SLIPWAY_DATA_FOLDER});
  ASSERT_TRUE(service);
  const auto request = read_diagnosis(**service, R"({"campaign":"p05","reference":"p01"})");
  ASSERT_TRUE(request);
  EXPECT_EQ(request->reference, "p01");
  for (const char* reference : {"p99", "p05", "../p01"}) {
    const auto refused =
        read_diagnosis(**service, R"({"campaign":"p05","reference":")" + std::string(reference) + "\"}");
    ASSERT_FALSE(refused) << reference;
    EXPECT_EQ(refused.error().faults.at(0).pointer, "/reference") << reference;
  }
}

}  // namespace
}  // namespace slipway::api
