// Plans and predictions with the model of a diagnosis that is named by its job.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/documents/diagnosis/diagnosis_document.h"
#include "api/documents/prediction_answer.h"
#include "api/files/corrected_model.h"
#include "api/files/model_folder.h"
#include "api/job_kinds.h"
#include "api/jobs/open_job_store.h"
#include "api/model_reference.h"
#include "api/service_drives.h"
#include "made_diagnosis.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using testing::small_world;

const gap::DriveCampaign& campaign() {
  static const gap::DriveCampaign kCampaign = testing::practice_campaign();
  return kCampaign;
}

std::string request_with(const std::string& model) {
  return R"({"terrain":"yard","rover":"mer-class","path":[{"x_m":20,"y_m":30},{"x_m":26,"y_m":30}],"draws":2)" +
         (model.empty() ? "" : R"(,"model":)" + model) + "}";
}
std::string naming(const std::string& job, const std::string& more = "") {
  return R"({"diagnosis":")" + job + "\"" + more + "}";
}

class ANamedModel : public ::testing::Test {
 protected:
  // A job of this kind that has ended with this, or that waits.
  void add(const std::string& id, std::string_view kind, const std::optional<std::string>& outcome) {
    ASSERT_TRUE(store_->append({id, std::string(kind), "{}"}, 0, {10}));
    if (!outcome) return;
    const auto claimed = store_->claim("test", {std::string(kind)}, 0, 1000);
    ASSERT_TRUE(claimed && *claimed);
    ASSERT_TRUE(store_->finish((*claimed)->lease(), JobState::kSuccessful, *outcome, 1));
  }
  static std::string document(const gap::Diagnosis& diagnosis) {
    return json::diagnosis_document(campaign(), diagnosis) + "\n<!DOCTYPE html>";
  }
  Result<std::string> recorded(const std::string& request) {
    return recordable_request(request, *store_, [](std::string_view body) -> std::optional<Error> {
      const auto reading = read_prediction(small_world(), body);
      return reading ? std::nullopt : std::optional<Error>(reading.error());
    });
  }
  static std::string predicted(const Service& service, const std::string& request) {
    NoProgress progress;
    const auto reading = read_prediction(service, request);
    EXPECT_TRUE(reading) << (reading ? "" : reading.error().detail);
    const auto answer = run_prediction(service, *reading, progress);
    EXPECT_TRUE(answer);
    return json::write_prediction_answer(*answer);
  }

  std::unique_ptr<JobStore> store_ = open_job_store("").value();
};

TEST_F(ANamedModel, IsRecordedWithTheRequestAndNeedsItsJobNoMore) {
  const gap::Diagnosis diagnosis = testing::full_diagnosis(campaign());
  add("d1", kDiagnosisKind, document(diagnosis));
  const auto request = recorded(request_with(naming("d1", R"(,"ground":["mer_b_sandy_loam"])")));
  ASSERT_TRUE(request) << request.error().detail;
  store_ = open_job_store("").value();

  // As the command line plans with the folder of the same model.
  const testing::ScratchFolder folder;
  const auto model = corrected_model(campaign(), diagnosis);
  testing::copy_small_world(folder.path());
  std::filesystem::create_directories(folder.path() / "model" / "rovers");
  std::filesystem::create_directories(folder.path() / "model" / "soils");
  testing::write_file(folder.path() / "model" / "model.json", model_document(campaign(), *model));
  testing::write_file(folder.path() / "model" / "rovers" / (model->rover.name + ".json"),
                      json::rover_document(*model));
  testing::write_file(folder.path() / "model" / "soils" / (model->soils.front().name + ".json"),
                      json::soils_document(*model));
  const auto loaded = load_model_folder(folder.path() / "model");
  ASSERT_TRUE(loaded) << loaded.error().detail;
  ASSERT_TRUE(loaded->model.left_open);
  EXPECT_EQ(loaded->model.left_open->names, diagnosis.left_open.names);
  EXPECT_TRUE(loaded->model.left_open->covariance.isApprox(diagnosis.left_open.covariance, 1e-5));
  const auto service = Service::open({.data = folder.path(),
                                      .threads = 1,
                                      .model = folder.path() / "model",
                                      .ground = {"mer_b_sandy_loam"}});
  ASSERT_TRUE(service) << service.error().detail;
  std::string by_folder = request_with("");
  by_folder.replace(by_folder.find("mer-class"), 9, model->rover.name);
  const std::string expected = predicted(**service, by_folder);
  std::string answer = predicted(small_world(), *request);
  const std::string named = R"(,"model":{"diagnosis":"d1","ground":["mer_b_sandy_loam"]})";
  ASSERT_NE(answer.find(named), std::string::npos) << "the answer says what it was asked with";
  answer.erase(answer.find(named), named.size());
  EXPECT_EQ(answer, expected);
}

TEST_F(ANamedModel, MayBeOfAWatchWhoseAlarmWasDiagnosed) {
  const gap::Diagnosis diagnosis = testing::full_diagnosis(campaign());
  add("d1", kDiagnosisKind, document(diagnosis));
  add("w1", kWatchKind,
      R"({"format":"watch/1","changed":true,"diagnosis":)" + json::diagnosis_document(campaign(), diagnosis) +
          "}");
  std::string of_diagnosis = recorded(request_with(naming("d1"))).value();
  of_diagnosis.replace(of_diagnosis.find("\"d1\""), 4, "\"w1\"");
  EXPECT_EQ(recorded(request_with(naming("w1"))).value(), of_diagnosis);
}

TEST_F(ANamedModel, LeavesRequestsWithoutOneAsTheyCame) {
  const std::string request = " " + request_with("");
  const auto same = recorded(request);
  ASSERT_TRUE(same);
  EXPECT_EQ(*same, request);
  EXPECT_EQ(recorded("{").error().code, ErrorCode::kMalformedJson);
}

TEST_F(ANamedModel, ThatThereIsNotIsRefusedWithItsPlaceAndTheReason) {
  gap::Diagnosis none = testing::full_diagnosis(campaign());
  none.model.reset();
  none.verdict = gap::Verdict::kNoGap;
  add("ended", kDiagnosisKind, document(none));
  add("old", kDiagnosisKind,
      R"({"format":"diagnosis/1","verdict":"effects","model":{"rover":{},"soils":{}}})");
  add("plan", kPlanKind, "{}");
  add("calm", kWatchKind, R"({"format":"watch/1","changed":false})");
  add("waits", kDiagnosisKind, std::nullopt);
  const std::vector<std::pair<std::string, std::string>> reasons{
      {"nobody", "there is no job of this id"},
      {"plan", "the job is a plan: only a diagnosis, or a watch that made one, offers a model"},
      {"calm", "the watch made no diagnosis, so that it offers no model"},
      {"waits", "the diagnosis is accepted: it offers no model yet"},
      {"ended", "the diagnosis offers no model: its verdict is no_gap"},
      {"old",
       "the diagnosis was made by an earlier version: its model has no \"campaign\"; ask for it again"}};
  for (const auto& [job, reason] : reasons) {
    const auto refused = recorded(request_with(naming(job)));
    ASSERT_FALSE(refused) << job;
    EXPECT_EQ(refused.error().code, ErrorCode::kInvalidRequest);
    EXPECT_EQ(refused.error().faults, (std::vector<Fault>{{"/model/diagnosis", reason}}));
  }
}

TEST_F(ANamedModel, IsRefusedTogetherWithTheRestOfTheRequest) {
  std::string request = request_with(R"({"diagnosis":"nobody"})");
  request.replace(request.find("mer-class"), 9, "mer-klass");
  const auto refused = recorded(request);
  ASSERT_FALSE(refused);
  ASSERT_EQ(refused.error().faults.size(), 2U);
  EXPECT_EQ(refused.error().faults[0].pointer, "/rover");
  EXPECT_EQ(refused.error().faults[1].pointer, "/model/diagnosis");
  const auto mistyped = recorded(request_with(R"({"diagnosis":7,"grounds":[]})"));
  ASSERT_FALSE(mistyped);
  EXPECT_EQ(mistyped.error().faults.size(), 2U);
  EXPECT_EQ(recorded(request_with("7")).error().faults.at(0).pointer, "/model");
  add("d1", kDiagnosisKind, document(testing::full_diagnosis(campaign())));
  const auto elsewhere = recorded(request_with(naming("d1", R"(,"ground":["snad"])")));
  ASSERT_FALSE(elsewhere);
  EXPECT_EQ(elsewhere.error().faults.at(0).pointer, "/model/ground/0");
}

// Nobody plans with a rover of his own by calling it a model, nor names a job where there is no service.
TEST_F(ANamedModel, IsNamedAndNotGiven) {
  add("d1", kDiagnosisKind, document(testing::full_diagnosis(campaign())));
  const auto whole = recorded(request_with(naming("d1")));
  ASSERT_TRUE(whole);
  EXPECT_FALSE(recorded(*whole));
  const auto alone = read_prediction(small_world(), request_with(naming("d1")));
  ASSERT_FALSE(alone);
  EXPECT_EQ(alone.error().faults.at(0).pointer, "/model/diagnosis");
}

TEST_F(ANamedModel, IsRefusedForAnotherRoverAndForGroundThatIsNotThere) {
  add("d1", kDiagnosisKind, document(testing::full_diagnosis(campaign())));
  std::string request = request_with(naming("d1", R"(,"ground":["jlu_mars_3_loose"])"));
  request.replace(request.find("mer-class"), 9, "msl-class");
  const auto refused = recorded(request);
  ASSERT_FALSE(refused);
  std::vector<std::string> places;
  for (const Fault& fault : refused.error().faults) places.push_back(fault.pointer);
  EXPECT_EQ(places, (std::vector<std::string>{"/rover", "/model/ground/0"}));
}

}  // namespace
}  // namespace slipway::api
