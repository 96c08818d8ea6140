// What stands on a store hands its refusals on, and says nothing that the store has not said.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/jobs/artefact_job_store.h"
#include "api/jobs/open_job_store.h"
#include "api/uploads/artefact_folder.h"
#include "core/utc.h"
#include "postgres_schema.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using testing::ScratchFolder;

// Refuses everything but to forget nothing.
class FailingStore final : public JobStore {
 public:
  Result<Job> append(const NewJob&, std::int64_t, const Admission&) override { return gone(); }
  Result<std::int64_t> lease_clock() override { return gone(); }
  Result<std::vector<ClaimedJob>> claim_some(std::string_view, const std::vector<std::string>&, std::int64_t,
                                             LeaseTerm, int) override {
    return gone();
  }
  Result<int> give_back(const std::vector<Lease>&) override { return gone(); }
  Result<bool> report(const Lease&, std::string_view, double, std::int64_t, std::string_view) override {
    return gone();
  }
  Result<std::vector<bool>> finish_all(const std::vector<JobEnd>&, std::int64_t) override { return gone(); }
  Result<bool> split(const Lease&, const std::vector<std::string>&, std::int64_t) override { return gone(); }
  Result<std::vector<Job>> parts(std::string_view) override { return gone(); }
  Result<int> release(std::string_view, HandBack, std::string_view) override { return gone(); }
  Result<std::optional<Job>> dismiss(std::string_view, std::int64_t) override { return gone(); }
  Result<std::optional<Job>> get(std::string_view) override { return gone(); }
  Result<std::optional<std::string>> request(std::string_view) override { return gone(); }
  Result<std::optional<std::string>> outcome(std::string_view) override { return gone(); }
  Result<std::optional<SeriesPage>> series(std::string_view, std::int64_t) override { return gone(); }
  Result<std::optional<QueuePlace>> place_in_queue(std::string_view,
                                                   const std::vector<std::string>&) override {
    return gone();
  }
  Result<std::vector<JobCount>> counts() override { return gone(); }
  Result<std::vector<Job>> list(std::size_t) override { return gone(); }
  Result<int> forget_ended(const Retention& kept, std::int64_t) override {
    if (kept.most == 0) return gone();
    return 0;
  }
  void listen(StoreNews, std::function<void()> call) override { call(); }

 private:
  static tl::unexpected<Error> gone() { return fail(ErrorCode::kStorage, "gone"); }
};

TEST(FailingStore, NoTermNoClaimAndNoEndIsMadeUp) {
  FailingStore store;
  EXPECT_EQ(store.lease_term(std::chrono::seconds(1)).error().detail, "gone");
  EXPECT_EQ(store.claim("a", {}, 1, 2).error().detail, "gone");
  EXPECT_EQ(store.finish({"id", 1}, JobState::kSuccessful, std::string("answer"), 3).error().detail, "gone");
}

TEST(FailingStore, AStoreWithArtefactsHandsItsRefusalsOn) {
  const ScratchFolder scratch;
  const auto store =
      with_artefacts(std::make_unique<FailingStore>(), ArtefactFolder::open(scratch.path()).value());
  EXPECT_EQ(store->series("id", 1).error().detail, "gone");
  EXPECT_EQ(store->finish({"id", 1}, JobState::kSuccessful, std::string("answer"), 3).error().detail, "gone");
  EXPECT_EQ(store->forget_ended({.most = 0}, now_ms()).error().detail, "gone");
  EXPECT_EQ(store->forget_ended({}, now_ms()).error().detail, "gone")
      << "it can't tell which pages are somebody's";
  EXPECT_EQ(store->forget_ended({}, now_ms()).value(), 0) << "an hour later it looks again";
  bool heard = false;
  store->listen(StoreNews::kEnded, [&] { heard = true; });
  EXPECT_TRUE(heard);
  const auto without = with_artefacts(std::make_unique<FailingStore>(), nullptr);
  EXPECT_EQ(without->forget_ended({}, now_ms()).value(), 0) << "it has no pages to look for";
  EXPECT_EQ(without->finish({"id", 1}, JobState::kSuccessful, std::string("answer"), 3).error().detail,
            "gone");
}

TEST(FailingStore, APageThatTheFolderCannotTakeEndsNoJob) {
  const ScratchFolder scratch;
  const auto folder = scratch.path() / "shared";
  const auto store = with_artefacts(open_job_store("").value(), ArtefactFolder::open(folder).value());
  const std::string id = store->append({new_job_id(), "map", "{}"}, 1, {})->id;
  EXPECT_EQ(store->series(id, 1).value().has_value(), false);
  const Lease lease = store->claim("a", {}, 2, 3).value()->lease();
  std::filesystem::remove_all(folder);
  testing::write_file(folder, "no folder");
  EXPECT_FALSE(
      store->finish(lease, JobState::kSuccessful, {"answer", {std::string(kMinArtefactBytes, 'x')}}, 4));
  EXPECT_EQ(store->get(id).value()->state, JobState::kRunning);
}

TEST(OpenJobStore, SecretsOfAnAddressGoIntoTheEnvironmentAlone) {
  EXPECT_EQ(without_secrets("jobs.sqlite").value(), "jobs.sqlite");
  ::unsetenv("PGPASSWORD");
  EXPECT_EQ(without_secrets("postgres://me@a/db").value(), "postgres://me@a/db");
  EXPECT_EQ(std::getenv("PGPASSWORD"), nullptr);
  EXPECT_EQ(without_secrets("postgresql://me:secret@a/db").value(), "postgresql://me@a/db");
  EXPECT_STREQ(std::getenv("PGPASSWORD"), "secret");
  ::unsetenv("PGPASSWORD");
  const auto faulty = without_secrets("postgresql://me:secret@[a/db");
  ASSERT_FALSE(faulty);
  EXPECT_EQ(faulty.error().faults.front().pointer, "/jobs");
  EXPECT_EQ(faulty.error().faults.front().message.find("secret"), std::string::npos);
}

TEST(OpenJobStore, AnAddressOpensAPostgresDatabase) {
  const auto schema = testing::PostgresSchema::make();
  if (!schema) GTEST_SKIP() << testing::kNoPostgres;
  const auto store = open_job_store(schema->address());
  ASSERT_TRUE(store) << store.error().detail;
  EXPECT_TRUE((*store)->append({new_job_id(), "plan", "{}"}, 1, {}));
}

}  // namespace
}  // namespace slipway::api
