#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <thread>

#include "api/chart/drive_history.h"
#include "api/documents/catalogue_documents.h"
#include "api/documents/diagnosis/diagnosis_document.h"
#include "api/documents/plan_answer.h"
#include "api/documents/soil/wheel_sweep_answer.h"
#include "api/job_kinds.h"
#include "api/jobs/open_job_store.h"
#include "api/json/parse.h"
#include "api/openapi.h"
#include "api/service_diagnoses.h"
#include "api/wheel_sweep.h"
#include "made_diagnosis.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using json::JsonValue;
using testing::example;
using testing::small_world;

const JsonValue& description() {
  static const JsonValue document = json::parse(openapi_document()).value();
  return document;
}

// What of JSON Schema the description uses: enough to hold an answer against it.
class Validator {
 public:
  void check(const JsonValue& schema, const JsonValue& value, const std::string& at) {
    if (const JsonValue* const reference = schema.find("$ref")) {
      const std::string name = reference->text.substr(std::string("#/components/schemas/").size());
      const JsonValue* const target = description().find("components")->find("schemas")->find(name);
      if (target == nullptr) return complain(at, "there is no schema " + name);
      return check(*target, value, at);
    }
    if (const JsonValue* const options = schema.find("oneOf")) return check_one_of(*options, value, at);
    if (const JsonValue* const constant = schema.find("const")) {
      if (constant->text != value.text) complain(at, "is not " + constant->text);
    }
    check_type(schema, value, at);
    if (value.is(JsonValue::Kind::kObject)) check_members(schema, value, at);
    if (value.is(JsonValue::Kind::kArray) && schema.find("items") != nullptr) {
      for (std::size_t i = 0; i < value.elements.size(); ++i) {
        check(*schema.find("items"), value.elements[i], json::child_pointer(at, i));
      }
    }
  }
  const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  void complain(const std::string& at, const std::string& what) { complaints_.push_back(at + " " + what); }

  void check_one_of(const JsonValue& options, const JsonValue& value, const std::string& at) {
    int fitting = 0;
    for (const JsonValue& option : options.elements) {
      Validator one;
      one.check(option, value, at);
      fitting += one.complaints().empty() ? 1 : 0;
    }
    if (fitting != 1) complain(at, "fits " + std::to_string(fitting) + " of the schemas");
  }

  static bool is_of(const std::string& type, const JsonValue& value) {
    switch (value.kind) {
      case JsonValue::Kind::kNull:
        return type == "null";
      case JsonValue::Kind::kBoolean:
        return type == "boolean";
      case JsonValue::Kind::kNumber:
        return type == "number" || (type == "integer" && value.number == std::floor(value.number));
      case JsonValue::Kind::kString:
        return type == "string";
      case JsonValue::Kind::kArray:
        return type == "array";
      case JsonValue::Kind::kObject:
        return type == "object";
    }
    return false;
  }

  void check_type(const JsonValue& schema, const JsonValue& value, const std::string& at) {
    const JsonValue* const type = schema.find("type");
    if (type == nullptr) return;
    bool fits = type->is(JsonValue::Kind::kString) && is_of(type->text, value);
    for (const JsonValue& one : type->elements) fits = fits || is_of(one.text, value);
    if (!fits) complain(at, "is " + json::describe(value));
  }

  void check_members(const JsonValue& schema, const JsonValue& value, const std::string& at) {
    const JsonValue* const properties = schema.find("properties");
    const JsonValue* const more = schema.find("additionalProperties");
    for (std::size_t i = 0; i < value.keys.size(); ++i) {
      const JsonValue* const property = properties == nullptr ? nullptr : properties->find(value.keys[i]);
      const std::string place = json::child_pointer(at, value.keys[i]);
      if (property != nullptr) {
        check(*property, value.elements[i], place);
      } else if (more != nullptr && more->is(JsonValue::Kind::kObject)) {
        check(*more, value.elements[i], place);
      } else if (more != nullptr && more->is(JsonValue::Kind::kBoolean) && !more->boolean) {
        complain(place, "is not described");
      }
    }
    const JsonValue* const required = schema.find("required");
    if (required == nullptr) return;
    for (const JsonValue& key : required->elements) {
      if (value.find(key.text) == nullptr) complain(at, "has no " + key.text);
    }
  }

  std::vector<std::string> complaints_;
};

std::vector<std::string> complaints_about(const std::string& schema, const std::string& bytes) {
  const auto value = json::parse(bytes, {.bytes = bytes.size(), .values = bytes.size()});
  if (!value) return {value.error().detail};
  Validator validator;
  validator.check(*description().find("components")->find("schemas")->find(schema), *value, "");
  return validator.complaints();
}

std::string answer_to(std::string_view kind, const std::string& request) {
  NoProgress progress;
  const auto answer = service_work(small_world())(std::string(kind), request, progress);
  EXPECT_TRUE(answer) << answer.error().detail;
  return answer ? answer->bytes : "";
}

TEST(Validator, FindsWhatIsWrong) {
  // Two that are wrong, and the rover and the goal that are missing; telemetry may stand in for a start.
  EXPECT_EQ(complaints_about("PlanRequest", R"({"terrain":3,"more":1})").size(), 4U);
}

TEST(Contract, ExamplesOfRequestsFitTheDescription) {
  for (const char* name : {"plan_shortest.json", "plan_every_key.json"}) {
    EXPECT_EQ(complaints_about("PlanRequest", example(name)), std::vector<std::string>{}) << name;
  }
  for (const char* name : {"prediction_path.json", "prediction_dynamic.json"}) {
    EXPECT_EQ(complaints_about("PredictionRequest", example(name)), std::vector<std::string>{}) << name;
  }
  EXPECT_EQ(complaints_about("WheelSweepRequest", example("wheel_sweep_every_key.json")),
            std::vector<std::string>{});
  EXPECT_EQ(complaints_about("DiagnosisRequest", example("diagnosis_practice.json")),
            std::vector<std::string>{});
  EXPECT_EQ(complaints_about("SoilEstimateRequest", example("soil_estimate_every_key.json")),
            std::vector<std::string>{});
}

TEST(Contract, ASoilEstimateFitsTheDescription) {
  const auto request = read_soil_estimate(small_world(), R"({"plate_tests":[{"plate_radius_m":0.05,
    "sinkage_m":[0.005,0.01,0.02],"pressure_pa":[4900,10100,21300]}]})");
  ASSERT_TRUE(request) << request.error().detail;
  const std::string document = answer_to("soil_estimate", R"({"plate_tests":[{"plate_radius_m":0.05,
    "sinkage_m":[0.005,0.01,0.02],"pressure_pa":[4900,10100,21300]}]})");
  EXPECT_EQ(complaints_about("SoilEstimate", document), std::vector<std::string>{});
  EXPECT_TRUE(json::geojson_of(document));
}

TEST(Contract, ADiagnosisFitsTheDescriptionWhateverIsInIt) {
  const gap::DriveCampaign campaign = testing::practice_campaign();
  EXPECT_EQ(complaints_about("Diagnosis", json::diagnosis_document(campaign, {})),
            std::vector<std::string>{});
  const gap::Diagnosis full = testing::full_diagnosis(campaign);
  const std::string document = json::diagnosis_document(campaign, full);
  EXPECT_EQ(complaints_about("Diagnosis", document), std::vector<std::string>{});
  EXPECT_EQ(document, json::diagnosis_document(campaign, full));
  const auto shipped = Service::open({.data = SLIPWAY_DATA_FOLDER});
  ASSERT_TRUE(shipped);
  EXPECT_EQ(complaints_about("DriveCampaigns", json::write_drive_campaigns((*shipped)->campaigns())),
            std::vector<std::string>{});
  EXPECT_EQ(json::geojson_of(document).value_or("").find("FeatureCollection") != std::string::npos, true);
}

TEST(Contract, AWheelSweepsAnswerFitsTheDescription) {
  const auto answer = run_wheel_sweep(*small_world().catalogue(), example("wheel_sweep_every_key.json"));
  ASSERT_TRUE(answer) << answer.error().detail;
  const std::string document = json::write_wheel_sweep_answer(*answer);
  EXPECT_EQ(complaints_about("WheelSweep", document), std::vector<std::string>{});
  EXPECT_EQ(json::parse(document)->find("rows")->elements.size(), 18U);
}

TEST(Contract, APlansAnswerFitsTheDescription) {
  const std::string answer = answer_to(kPlanKind, example("plan_every_key.json"));
  EXPECT_EQ(complaints_about("Plan", answer), std::vector<std::string>{});
  const auto document = json::parse(answer, {.bytes = answer.size(), .values = answer.size()});
  ASSERT_TRUE(document);
  const JsonValue& routes = *document->find("routes")->find("features");
  EXPECT_EQ(routes.elements.size(), document->find("summary")->elements.size());
  ASSERT_FALSE(routes.elements.empty()) << json::describe(*document->find("fewer_because"));
  const JsonValue& stations = *routes.elements[0].find("properties")->find("stations");
  const std::size_t count = static_cast<std::size_t>(stations.find("count")->number);
  for (const char* column : {"distance_m", "slip", "slip_p95", "risk", "soil", "elapsed_s"}) {
    EXPECT_EQ(stations.find(column)->elements.size(), count) << column;
  }
  EXPECT_EQ(stations.find("wheels")->find("rr")->find("current_a")->elements.size(), count);
  int verified = 0;
  for (const JsonValue& route : document->find("summary")->elements)
    verified += route.find("dynamic") != nullptr ? 1 : 0;
  EXPECT_EQ(verified, 1);
}

TEST(Contract, ADynamicPredictionsAnswerFitsTheDescriptionAndNamesItsRung) {
  const std::string answer = answer_to(kPredictionKind, example("prediction_dynamic.json"));
  EXPECT_EQ(complaints_about("Prediction", answer), std::vector<std::string>{});
  EXPECT_EQ(answer, answer_to(kPredictionKind, example("prediction_dynamic.json")));
  const auto document = json::parse(answer, {.bytes = answer.size(), .values = answer.size()});
  const JsonValue& figures = *document->find("summary")->find("dynamic");
  EXPECT_EQ(figures.find("fidelity")->text, "dynamic");
  EXPECT_EQ(figures.find("samples"), nullptr);
  const JsonValue& drive =
      *document->find("routes")->find("features")->elements[0].find("properties")->find("dynamic");
  const JsonValue& samples = *drive.find("samples");
  const auto count = static_cast<std::size_t>(samples.find("count")->number);
  EXPECT_GT(count, 50U);
  EXPECT_LE(count, 400U);
  for (const char* column : {"time_s", "x_m", "slip", "driving"})
    EXPECT_EQ(samples.find(column)->elements.size(), count) << column;
  const JsonValue& dead = *samples.find("wheels")->find("lr");
  EXPECT_EQ(dead.find("current_a")->elements.size(), count);
  EXPECT_EQ(dead.find("torque_nm")->elements.size(), count);
  for (const JsonValue& current : dead.find("current_a")->elements)
    EXPECT_EQ(current.number, 0.0) << "a motor without power draws none";
}

TEST(DriveHistory, IsDrawnOfAPredictionsDynamicDrive) {
  const std::string answer = answer_to(kPredictionKind, example("prediction_dynamic.json"));
  const auto svg = draw_drive_history(answer);
  ASSERT_TRUE(svg) << svg.error().detail;
  for (const char* words :
       {"slip", "attitude, deg", "sinkage, mm", "motor current, A", "torque, N m", "load, N"})
    EXPECT_NE(svg->find(words), std::string::npos) << words;
  EXPECT_EQ(*svg, *draw_drive_history(answer));
  // Each wheel has its name in the legend.
  for (const char* wheel : {"lf", "lm", "lr", "rf", "rm", "rr"})
    EXPECT_NE(svg->find(std::string(">") + wheel + "<"), std::string::npos) << wheel;
}

TEST(DriveHistory, SaysWhyThereIsNone) {
  const auto none = draw_drive_history(answer_to(kPredictionKind, example("prediction_path.json")));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kNoData);
  std::string cut = answer_to(kPredictionKind, example("prediction_dynamic.json"));
  const std::size_t torque = cut.find("\"torque_nm\"", cut.find("\"samples\""));
  ASSERT_NE(torque, std::string::npos);
  const auto misfit = draw_drive_history(cut.replace(torque + 1, 9, "torque_xx"));
  ASSERT_FALSE(misfit);
  EXPECT_EQ(misfit.error().code, ErrorCode::kInternal);
  EXPECT_FALSE(draw_drive_history("{"));
}

TEST(Contract, WithoutADynamicRungNothingIsSaidOfOne) {
  const std::string answer = answer_to(kPredictionKind, example("prediction_path.json"));
  EXPECT_EQ(answer.find("\"dynamic\":{"), std::string::npos);
}

TEST(Contract, APredictionsAnswerFitsTheDescription) {
  const std::string answer = answer_to(kPredictionKind, example("prediction_path.json"));
  EXPECT_EQ(complaints_about("Prediction", answer), std::vector<std::string>{});
  EXPECT_TRUE(json::geojson_of(answer));
}

TEST(Contract, TheSameRequestHasTheSameBytes) {
  EXPECT_EQ(answer_to(kPredictionKind, example("prediction_path.json")),
            answer_to(kPredictionKind, example("prediction_path.json")));
  EXPECT_EQ(answer_to(kPlanKind, example("plan_shortest.json")),
            answer_to(kPlanKind, example("plan_shortest.json")));
}

TEST(Contract, APathThroughAHoleNamesTheCorner) {
  NoProgress progress;
  const auto answer = service_work(small_world())(
      std::string(kPredictionKind),
      R"({"terrain":"yard","rover":"mer-class","path":[{"x_m":75,"y_m":45},{"x_m":95,"y_m":45}],"draws":1})",
      progress);
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kNoData);
  ASSERT_FALSE(answer.error().faults.empty());
  EXPECT_TRUE(answer.error().faults.front().pointer.starts_with("/path/"))
      << answer.error().faults.front().pointer;
}

TEST(Contract, DismissingAPlanStopsThePlannersWithinTwoSeconds) {
  JobRunner runner(open_job_store("").value(), service_work(small_world()));
  ASSERT_TRUE(runner.start());
  const auto job = runner.submit("plan", example("plan_shortest.json"));
  ASSERT_TRUE(job);
  const auto works = [&] {
    const Job now = runner.store().get(job->id).value().value();
    return runner.running() == 1 && !now.stage.empty() && now.stage != "starting" && now.progress > 0.0;
  };
  for (int i = 0; i < 20000 && !works(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_TRUE(works()) << "it must be stopped in the midst of its work";
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(runner.dismiss(job->id));
  while (runner.running() > 0 && std::chrono::steady_clock::now() - begin < std::chrono::seconds(30)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  std::cout << "stopped after " << took.count() << " s\n";
  EXPECT_LT(took.count(), 2.0);
}

}  // namespace
}  // namespace slipway::api
