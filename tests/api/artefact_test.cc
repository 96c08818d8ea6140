// Large pages in a folder that machines share.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "api/jobs/artefact_job_store.h"
#include "api/jobs/postgres_job_store.h"
#include "api/jobs/sqlite_job_store.h"
#include "api/uploads/artefact_folder.h"
#include "core/utc.h"
#include "postgres_schema.h"
#include "small_world.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

// Of all files below it.
std::vector<fs::path> files_of(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  return files;
}

// As if nobody had put or read it for so long.
void make_older(const fs::path& file, std::int64_t by_s) {
  struct stat status {};
  ASSERT_EQ(::stat(file.c_str(), &status), 0);
  const std::array<timespec, 2> times{{{status.st_mtim.tv_sec - by_s, 0}, {status.st_mtim.tv_sec - by_s, 0}}};
  ASSERT_EQ(::utimensat(AT_FDCWD, file.c_str(), times.data(), 0), 0);
}

TEST(ArtefactFolder, TheSameBytesAreOneFileAndAlteredOnesAreNeverRead) {
  const ScratchFolder scratch;
  const auto folder = ArtefactFolder::open(scratch.path() / "shared").value();
  const std::string bytes("a\0b", 3);
  const std::string name = folder->put(bytes).value();
  EXPECT_EQ(folder->put(bytes).value(), name);
  EXPECT_EQ(folder->get(name).value(), bytes);
  ASSERT_EQ(files_of(scratch.path()).size(), 1U) << "nothing unfinished is left";
  testing::write_file(files_of(scratch.path()).front(), "a\0c");
  EXPECT_EQ(folder->get(name).error().code, ErrorCode::kDamagedStore);
  EXPECT_EQ(folder->put(bytes).value(), name);
  EXPECT_EQ(folder->get(name).value(), bytes) << "who puts it again mends it";
  EXPECT_EQ(folder->get(std::string(64, '0')).error().code, ErrorCode::kStorage);
}

TEST(ArtefactFolder, AMachineKeepsCopiesWithinItsBound) {
  const ScratchFolder scratch;
  const fs::path shared = scratch.path() / "shared", cache = scratch.path() / "cache";
  const auto folder = ArtefactFolder::open(shared, {.folder = cache, .max_bytes = 250}).value();
  std::vector<std::string> names;
  for (const char c : {'a', 'b', 'c'}) names.push_back(folder->put(std::string(100, c)).value());
  EXPECT_EQ(files_of(cache).size(), 0U);
  ASSERT_TRUE(folder->get(names[0]) && folder->get(names[1]));
  make_older(cache / names[0], 20);
  make_older(cache / names[1], 10);
  fs::remove_all(shared);
  EXPECT_TRUE(folder->get(names[0])) << "from the copy, which counts as used now";
  fs::create_directories(shared);
  ASSERT_EQ(folder->put(std::string(100, 'c')).value(), names[2]);
  ASSERT_TRUE(folder->get(names[2]));
  EXPECT_FALSE(fs::exists(cache / names[1])) << "the one that was not used for longest";
  EXPECT_TRUE(fs::exists(cache / names[0]) && fs::exists(cache / names[2]));
  testing::write_file(cache / names[2], "altered");
  EXPECT_EQ(folder->get(names[2]).value(), std::string(100, 'c'));
}

TEST(ArtefactFolder, WhatNobodyPutsAnyMoreGoes) {
  const ScratchFolder scratch;
  const auto folder = ArtefactFolder::open(scratch.path()).value();
  const std::string old = folder->put("old").value(), again = folder->put("again").value();
  for (const fs::path& file : files_of(scratch.path())) make_older(file, 100);
  folder->put("again").value();
  EXPECT_EQ(folder->forget_before(now_ms() - 50'000), 1);
  EXPECT_FALSE(folder->get(old));
  EXPECT_TRUE(folder->get(again));
}

TEST(ArtefactJobStore, LargePagesAreInTheFolderAndSmallOnesInTheRow) {
  const ScratchFolder scratch;
  const fs::path shared = scratch.path() / "shared";
  const auto open = [&] {
    return with_artefacts(open_sqlite_job_store(scratch.path() / "jobs.sqlite").value(),
                          ArtefactFolder::open(shared).value());
  };
  auto store = open();
  const std::string id = store->append({new_job_id(), "map", "{}"}, 1, {})->id;
  const std::vector<std::string> pages{std::string(kMinArtefactBytes, 'x'), "small",
                                       std::string("\0slipway artefact\0", 18) + "forged"};
  const Lease lease = store->claim("a", {}, 2, 3).value()->lease();
  ASSERT_TRUE(store->finish(lease, JobState::kSuccessful, {"answer", pages}, 4).value());
  EXPECT_EQ(files_of(shared).size(), 2U);
  store.reset();
  store = open();
  for (std::size_t k = 0; k < pages.size(); ++k) {
    const auto page = store->series(id, static_cast<std::int64_t>(k + 1)).value();
    EXPECT_EQ(page->bytes, pages[k]);
    EXPECT_EQ(page->more, k + 1 < pages.size());
  }
  const auto without = with_artefacts(open_sqlite_job_store(scratch.path() / "jobs.sqlite").value(), nullptr);
  EXPECT_EQ(without->series(id, 1).error().code, ErrorCode::kStorage) << "never the name instead of the page";
  EXPECT_EQ(without->series(id, 2).value()->bytes, "small");
  for (const fs::path& file : files_of(shared)) testing::write_file(file, "altered");
  EXPECT_EQ(store->series(id, 1).error().code, ErrorCode::kDamagedStore);
}

// Of two jobs with a page of a megabyte each.
void expect_pages_to_count(std::unique_ptr<JobStore> rows, const fs::path& shared) {
  const auto store = with_artefacts(std::move(rows), ArtefactFolder::open(shared).value());
  for (int k = 0; k < 2; ++k) {
    ASSERT_TRUE(store->append({new_job_id(), "map", "{}"}, 1, {}));
    const Lease lease = store->claim("a", {}, 2, 3).value()->lease();
    const std::string page = "\0" + std::string(1'000'000, k == 0 ? 'x' : 'y');
    ASSERT_TRUE(store->finish(lease, JobState::kSuccessful, {"answer", {page}}, 4).value());
  }
  ASSERT_EQ(files_of(shared).size(), 2U);
  EXPECT_EQ(store->forget_ended({.most_bytes = 2'100'000}, 5).value(), 0);
  EXPECT_EQ(store->forget_ended({.most_bytes = 1'900'000}, 5).value(), 1);
}

TEST(ArtefactJobStore, PagesInTheFolderCountForTheBytesThatAreKept) {
  const ScratchFolder scratch;
  expect_pages_to_count(open_sqlite_job_store(scratch.path() / "jobs.sqlite").value(),
                        scratch.path() / "shared");
}

TEST(ArtefactJobStore, PagesInTheFolderCountInPostgresTables) {
  const auto schema = testing::PostgresSchema::make();
  if (!schema) GTEST_SKIP() << testing::kNoPostgres;
  const ScratchFolder scratch;
  expect_pages_to_count(open_postgres_job_store(schema->address()).value(), scratch.path() / "shared");
}

TEST(ArtefactJobStore, PagesGoAfterTheirJobs) {
  const ScratchFolder scratch;
  const fs::path shared = scratch.path() / "shared";
  const auto store = with_artefacts(open_sqlite_job_store(scratch.path() / "jobs.sqlite").value(),
                                    ArtefactFolder::open(shared).value());
  const std::int64_t begun = now_ms(), day = std::int64_t{24} * 3600 * 1000;
  ASSERT_TRUE(store->append({new_job_id(), "map", "{}"}, begun, {}));
  const Lease lease = store->claim("a", {}, begun, begun + 1).value()->lease();
  const JobAnswer answer("answer", {std::string(kMinArtefactBytes, 'x')});
  ASSERT_TRUE(store->finish(lease, JobState::kSuccessful, answer, begun).value());
  const Retention ten_days{.most_age_ms = 10 * day};
  EXPECT_EQ(store->forget_ended(ten_days, begun + 9 * day).value(), 0);
  EXPECT_EQ(files_of(shared).size(), 1U);
  EXPECT_EQ(store->forget_ended(ten_days, begun + 10 * day + 1000).value(), 1);
  EXPECT_EQ(files_of(shared).size(), 1U) << "for another day, as a job may be ending with it";
  EXPECT_EQ(store->forget_ended(ten_days, begun + 11 * day + 60'000).value(), 0);
  EXPECT_EQ(files_of(shared).size(), 0U);
}

}  // namespace
}  // namespace slipway::api
