// Requests that append drives to a watch: what is read, what is recorded.
#include "api/documents/diagnosis/watch_request.h"

#include <gtest/gtest.h>

#include <string>

#include "api/continued_request.h"
#include "api/jobs/open_job_store.h"
#include "api/json/parse.h"
#include "drive_campaign_folder.h"

namespace slipway::api {
namespace {

std::string drive(const std::string& id, const std::string& more = "") {
  return R"({"id":")" + id + R"(","terrain":"level","commanded":{"speed_m_s":0.05,"curvature_1_m":0,)" +
         R"("turn_in_place":false,"duration_s":4},"csv":"t_s,x_m,y_m,z_m,lf_current_a\n0,1,2,0.5,0.25\n2,1.1,2,0.5,0.3\n")" +
         more + "}";
}

class AWatchRequest : public testing::DriveCampaignFolder {
 protected:
  Result<Reading<WatchRequest>> read(const std::string& body) const {
    return json::read_watch_request(body, [this](const std::string& name) -> Result<gap::DriveCampaign> {
      if (name != "small") return fail(ErrorCode::kInvalidRequest, "there is no such campaign");
      return load();
    });
  }
  // Pointers of what is wrong with a request.
  std::vector<std::string> faults(const std::string& body) const {
    std::vector<std::string> pointers;
    const auto reading = read(body);
    EXPECT_TRUE(reading);
    if (reading)
      for (const Fault& fault : reading->faults) pointers.push_back(fault.pointer);
    return pointers;
  }
};

TEST_F(AWatchRequest, HasTheDrivesInTheSettingOfTheReference) {
  const auto reading = read(R"({"reference":"small","alpha":0.001,"diagnose":false,"drives":[)" +
                            drive("s1") + "," + drive("s2", R"(,"repeat_of":"s1")") + "]}");
  ASSERT_TRUE(reading);
  ASSERT_TRUE(reading->faults.empty()) << reading->faults.front().message;
  const WatchRequest& request = reading->request;
  EXPECT_EQ(request.alpha, 0.001);
  EXPECT_FALSE(request.diagnose);
  EXPECT_EQ(request.healthy->drives.size(), 2U);
  ASSERT_EQ(request.watched.drives.size(), 2U);
  EXPECT_EQ(request.watched.rover, request.healthy->rover);
  EXPECT_EQ(request.watched.drives[1].id, "s2");
  EXPECT_EQ(request.watched.drives[1].repeat_of, "s1");
  EXPECT_EQ(request.watched.drives[0].samples.size(), 2U);
  EXPECT_NE(request.watched.fingerprint, request.healthy->fingerprint);
}

TEST_F(AWatchRequest, TellsEveryFaultAtItsPlace) {
  EXPECT_EQ(faults("{}"), (std::vector<std::string>{"/reference", "/drives"}));
  EXPECT_EQ(faults(R"({"reference":"large","drives":[],"continues":"x"})"),
            (std::vector<std::string>{"/continues", "/reference"}));
  EXPECT_EQ(faults(R"({"reference":"small","drives":[]})"), std::vector<std::string>{"/drives"});
  EXPECT_EQ(faults(R"({"reference":"small","alpha":2,"without":["tether"],"drives":[)" + drive("a") + "," +
                   drive("a", R"(,"file":"../secret.csv","repeat_of":"b")") +
                   R"(,{"id":"c","terrain":"moon","csv":"t_s\nx"}]})"),
            (std::vector<std::string>{"/alpha", "/without/0", "/drives/1/id", "/drives/1/file",
                                      "/drives/2/terrain", "/drives/2/commanded", "/drives/2/csv",
                                      "/drives/2/csv", "/drives/1/repeat_of"}))
      << "a path of the service's files is no key";
}

TEST_F(AWatchRequest, TakesTheDrivesOfACampaignAndLearnsFromItsFirstOrFromAReference) {
  const auto first = read(R"({"campaign":"small","learn":3})");
  ASSERT_TRUE(first);
  ASSERT_EQ(first->faults.size(), 1U);
  EXPECT_EQ(first->faults.front().pointer, "/learn") << "it has two drives";
  EXPECT_EQ(faults(R"({"campaign":"small","learn":2})"), std::vector<std::string>{"/learn"}) << "too few";
  EXPECT_EQ(faults(R"({"campaign":"small"})"), std::vector<std::string>{"/learn"}) << "twelve are";
  EXPECT_EQ(first->request.healthy, nullptr);
  EXPECT_EQ(first->request.learn, 3);
  EXPECT_EQ(first->request.watched.drives.size(), 2U);
  EXPECT_EQ(first->request.watched.fingerprint, load()->fingerprint);
  EXPECT_EQ(faults(R"({"campaign":"small","reference":"small","learn":2,"drives":[]})"),
            (std::vector<std::string>{"/drives", "/learn", "/reference"}));
  EXPECT_EQ(faults(R"({"campaign":"large","reference":"large","learn":0})"),
            (std::vector<std::string>{"/reference", "/campaign", "/learn", "/reference"}));
  EXPECT_EQ(faults(R"({"reference":"small","learn":2,"drives":[)" + drive("a") + "]}"),
            std::vector<std::string>{"/learn"});
}

class AContinuedRequest : public ::testing::Test {
 protected:
  std::string job(const std::string& kind, const std::string& request) {
    const std::string id = new_job_id();
    EXPECT_TRUE(store_->append({id, kind, request}, 1, {100}));
    return id;
  }
  Result<std::string> recorded(const std::string& body, std::vector<Fault> faults = {}) {
    return continued_request(body, "watch", *store_, [&](std::string_view) -> std::optional<Error> {
      if (faults.empty()) return std::nullopt;
      return Error{ErrorCode::kInvalidRequest, "", faults};
    });
  }
  std::vector<std::string> refused(const std::string& body, std::vector<Fault> faults = {}) {
    std::vector<std::string> pointers;
    const auto answer = recorded(body, std::move(faults));
    EXPECT_FALSE(answer);
    if (!answer)
      for (const Fault& fault : answer.error().faults) pointers.push_back(fault.pointer);
    return pointers;
  }

  std::unique_ptr<JobStore> store_ = open_job_store("").value();
};

TEST_F(AContinuedRequest, IsRecordedWithAllDrivesSoThatTheEarlierJobMayBeForgotten) {
  const std::string first = job("watch", R"({"reference":"p01","alpha":0.02,"drives":[{"id":"a"}]})");
  const auto second = recorded(R"({"drives":[{"id":"b"},{"id":"c"}],"continues":")" + first + R"("})");
  ASSERT_TRUE(second);
  EXPECT_EQ(*second, R"({"reference":"p01","alpha":0.02,"drives":[{"id":"a"},{"id":"b"},{"id":"c"}]})");
  const std::string third_of = job("watch", *second);
  ASSERT_TRUE(store_->dismiss(first, 2));
  ASSERT_EQ(store_->forget_ended({.most = 0}, 3).value(), 1);
  const auto third = recorded(R"({"continues":")" + third_of + R"(","drives":[{"id":"d"}]})");
  ASSERT_TRUE(third);
  EXPECT_NE(third->find(R"({"id":"a"},{"id":"b"},{"id":"c"},{"id":"d"})"), std::string::npos);
  EXPECT_EQ(*recorded(R"({ "reference": "p01" })"), R"({ "reference": "p01" })") << "as it came";
}

TEST_F(AContinuedRequest, IsRefusedWhereThereIsNothingToContinue) {
  const std::string drives = R"(,"drives":[{"id":"b"}]})";
  const auto continues = [&](const std::string& id) { return R"({"continues":")" + id + "\"" + drives; };
  const std::vector<std::string> at{"/continues"};
  EXPECT_EQ(refused(continues(new_job_id())), at);
  EXPECT_EQ(refused(continues(job("plan", "{}"))), at);
  EXPECT_EQ(refused(continues(job("watch", R"({"campaign":"p05"})"))), at) << "it has no drives of its own";
  const std::string gone = job("watch", R"({"drives":[]})");
  ASSERT_TRUE(store_->dismiss(gone, 2));
  EXPECT_EQ(refused(continues(gone)), at);
  EXPECT_EQ(refused(R"({"continues":5,"alpha":0.1})"),
            (std::vector<std::string>{"/continues", "/drives", "/alpha"}));
}

TEST_F(AContinuedRequest, CountsFaultyDrivesAsTheyWereSent) {
  const std::string first = job("watch", R"({"drives":[{"id":"a"},{"id":"b"}]})");
  EXPECT_EQ(refused(R"({"continues":")" + first + R"(","drives":[{"id":"c"},{"id":"d"}]})",
                    {{"/drives/3/csv", "x"}, {"/drives/1/id", "y"}, {"/seed", "z"}}),
            (std::vector<std::string>{"/drives/1/csv", "/drives/1/id", "/seed"}));
}

}  // namespace
}  // namespace slipway::api
