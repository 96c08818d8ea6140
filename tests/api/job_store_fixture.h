#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "api/jobs/postgres_job_store.h"
#include "api/jobs/sqlite_job_store.h"
#include "postgres_schema.h"
#include "small_world.h"

namespace slipway::api::testing {

inline const std::vector<std::string> kJobStores{"memory", "sqlite", "postgresql"};
inline const std::vector<std::string> kBoth{"plan", "prediction"};
inline constexpr std::size_t kMany = 1000;

// A job divided into three parts, and their claims in their order.
struct Divided {
  std::string id;
  std::vector<ClaimedJob> parts;
};

// All implementations keep the same promises.
class JobStoreTest : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (GetParam() == "postgresql") {
      schema_ = PostgresSchema::make();
      if (!schema_) GTEST_SKIP() << kNoPostgres;
      auto opened = open_postgres_job_store(schema_->address());
      ASSERT_TRUE(opened) << opened.error().detail;
      store_ = std::move(*opened);
    } else {
      auto opened = open_sqlite_job_store(GetParam() == "memory" ? "" : folder_.path() / "jobs.sqlite");
      ASSERT_TRUE(opened) << opened.error().detail;
      store_ = std::move(*opened);
    }
  }

  std::string accept(const std::string& kind = "plan", const std::string& request = "{}") {
    const auto job = store_->append({new_job_id(), kind, request}, ++now_, {kMany});
    EXPECT_TRUE(job);
    return job->id;
  }
  ClaimedJob claim(std::int64_t lease = 1000) {
    auto claimed = store_->claim("a", kBoth, now_, now_ + lease);
    EXPECT_TRUE(claimed && *claimed);
    return **claimed;
  }
  Divided divide() {
    Divided job{accept("plan", "whole"), {}};
    EXPECT_TRUE(store_->split(claim().lease(), {"part 0", "part 1", "part 2"}, now_).value());
    for (int k = 0; k < 3; ++k) job.parts.push_back(claim(1'000'000));
    return job;
  }
  // The id of a job that was divided into so many parts.
  std::string split_into(int parts) {
    const std::string id = accept("plan", "whole");
    for (;;) {
      const ClaimedJob claimed = claim();
      if (claimed.job.id != id) continue;
      EXPECT_TRUE(store_
                      ->split(claimed.lease(),
                              std::vector<std::string>(static_cast<std::size_t>(parts), "part"), now_)
                      .value());
      return id;
    }
  }
  std::vector<ClaimedJob> claim_some(const std::string& worker, int most) {
    return store_->claim_some(worker, {}, now_, {now_, now_ + 1000}, most).value();
  }
  static JobAnswer answer_of_part(int part) {
    JobAnswer answer("answer " + std::to_string(part));
    answer.cpu_s = 0.5 + part;
    return answer;
  }
  Job get(const std::string& id) { return store_->get(id).value().value(); }

  void TearDown() override { store_.reset(); }

  ScratchFolder folder_;
  std::unique_ptr<PostgresSchema> schema_;
  std::unique_ptr<JobStore> store_;
  std::int64_t now_ = 1'700'000'000'000;
};

}  // namespace slipway::api::testing
