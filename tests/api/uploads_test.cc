// What clients send: unpacked within limits, kept by its bytes, old files go.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

#include "api/uploads/unpack.h"
#include "api/uploads/upload_folder.h"
#include "core/file_descriptor.h"
#include "core/progress.h"
#include "small_world.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

// An open file without a name, as a body comes.
FileDescriptor body(const fs::path& folder, const std::string& bytes) {
  FileDescriptor file(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
  EXPECT_EQ(::write(file.fd(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  return file;
}

std::string octal(std::size_t number, int digits) {
  std::string text(static_cast<std::size_t>(digits), '0');
  for (std::size_t k = text.size(); number > 0 && k-- > 0; number /= 8)
    text[k] = static_cast<char>('0' + static_cast<char>(number % 8));
  return text;
}

// One file in a tar archive [POSIX.1-1988, ustar].
std::string tar_entry(const std::string& name, const std::string& bytes, char type = '0') {
  std::string head(512, '\0');
  head.replace(0, name.size(), name);
  head.replace(100, 7, "0000644").replace(124, 11, octal(bytes.size(), 11)).replace(136, 11, octal(0, 11));
  head.replace(148, 8, "        ");
  head[156] = type;
  head.replace(257, 6, std::string("ustar\0", 6)).replace(263, 2, "00");
  std::size_t sum = 0;
  for (const char c : head) sum += static_cast<unsigned char>(c);
  head.replace(148, 7, octal(sum, 6) + std::string(1, '\0'));
  return head + bytes + std::string((512 - bytes.size() % 512) % 512, '\0');
}

Result<void> unpacked(const ScratchFolder& folder, const std::string& archive, const UnpackLimits& limits) {
  testing::write_file(folder.path() / "archive", archive + std::string(1024, '\0'));
  fs::create_directories(folder.path() / "into");
  NoProgress progress;
  return unpack(folder.path() / "archive", folder.path() / "into", limits, progress);
}

TEST(Unpacking, WritesPlainFilesInFolders) {
  const ScratchFolder folder;
  const auto done = unpacked(folder, tar_entry("a/b.csv", "1,2\n") + tar_entry("c.json", "{}"), {});
  ASSERT_TRUE(done) << done.error().detail;
  EXPECT_EQ(testing::file_bytes(folder.path() / "into" / "a" / "b.csv"), "1,2\n");
  EXPECT_EQ(testing::file_bytes(folder.path() / "into" / "c.json"), "{}");
}

TEST(Unpacking, StopsAtItsLimits) {
  const std::string three = tar_entry("a", "123") + tar_entry("b", "456") + tar_entry("c", "789");
  for (const UnpackLimits& limits :
       {UnpackLimits{.max_files = 2}, UnpackLimits{.max_bytes = 8}, UnpackLimits{.max_name = 0}}) {
    const ScratchFolder folder;
    const auto done = unpacked(folder, three, limits);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::kInvalidRequest);
  }
  const ScratchFolder folder;
  EXPECT_TRUE(unpacked(folder, three, {.max_files = 3, .max_bytes = 9, .max_depth = 0, .max_name = 1}));
  const ScratchFolder deep;
  EXPECT_FALSE(unpacked(deep, tar_entry("a/b", "1"), {.max_depth = 0}));
}

TEST(Unpacking, FoldersCountWhereverTheyComeFrom) {
  const std::string made = tar_entry("a/", "", '5') + tar_entry("b/", "", '5'),
                    same = tar_entry("a/", "", '5');
  const std::string file = tar_entry("c", "1");
  for (const std::string& archive :
       {made + file, same + same + same + file, tar_entry("a/b/c", "1") + file}) {
    const ScratchFolder folder;
    const auto done = unpacked(folder, archive, {.max_folders = 1});
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().detail.find("folders"), std::string::npos) << done.error().detail;
    const ScratchFolder wider;
    EXPECT_TRUE(unpacked(wider, archive, {.max_folders = 3}));
  }
}

TEST(Unpacking, TellsAllThatIsNoPlainFile) {
  const ScratchFolder folder;
  const auto done =
      unpacked(folder,
               tar_entry("../up", "x") + tar_entry("/abs", "x") + tar_entry("fifo", "", '6') +
                   tar_entry("device", "", '3') + tar_entry("twice", "1") + tar_entry("twice", "2"),
               {});
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().faults.size(), 5U) << done.error().detail;
  EXPECT_FALSE(fs::exists(folder.path() / "up"));
  EXPECT_EQ(testing::file_bytes(folder.path() / "into" / "twice"), "1");
}

TEST(Unpacking, ADamagedArchiveIsRefusedAndNoCrash) {
  std::string archive = tar_entry("a", std::string(2000, 'x')) + tar_entry("b", "y");
  for (std::size_t cut = 0; cut < archive.size(); cut += 97) {
    const ScratchFolder folder;
    testing::write_file(folder.path() / "archive", archive.substr(0, cut));
    fs::create_directories(folder.path() / "into");
    NoProgress progress;
    const auto done = unpack(folder.path() / "archive", folder.path() / "into", {}, progress);
    EXPECT_TRUE(done || !done.error().faults.empty());
  }
}

TEST(UploadFolder, FilesGoWithAgeAndNotBefore) {
  const ScratchFolder folder;
  auto uploads = UploadFolder::open(folder.path(), {.max_age_ms = 1000}).value();
  const auto first = uploads->keep(body(folder.path(), "one").fd(), "one.csv", {.owner = "ann", .at_ms = 10});
  ASSERT_TRUE(first) << first.error().detail;
  EXPECT_EQ(first->bytes, 3);
  EXPECT_EQ(uploads->find(first->id)->origin.owner, "ann");
  ASSERT_TRUE(uploads->keep(body(folder.path(), "two").fd(), "two.csv", {.at_ms = 1010}));
  EXPECT_EQ(uploads->list().size(), 2U);
  ASSERT_TRUE(uploads->keep(body(folder.path(), "three").fd(), "three.csv", {.at_ms = 1011}));
  EXPECT_FALSE(uploads->find(first->id));
  EXPECT_EQ(uploads->list().size(), 2U);
}

TEST(UploadFolder, AnAlteredFileIsNotGivenOut) {
  const ScratchFolder folder;
  auto uploads = UploadFolder::open(folder.path()).value();
  const auto kept = uploads->keep(body(folder.path(), "bytes").fd(), "a.csv", {});
  ASSERT_TRUE(kept);
  const auto path = uploads->verified(kept->id);
  ASSERT_TRUE(path);
  EXPECT_EQ(path->filename(), "a.csv");
  testing::write_file(*path, "other");
  EXPECT_EQ(uploads->verified(kept->id).error().code, ErrorCode::kDamagedStore);
  EXPECT_EQ(uploads->verified(std::string(64, '0')).error().code, ErrorCode::kNotFound);
  EXPECT_FALSE(uploads->find("../../etc"));
  EXPECT_FALSE(uploads->find(std::string(64, '.')));
}

TEST(UploadFolder, EachOwnerHasAnUploadOfTheSameBytes) {
  const ScratchFolder folder;
  auto uploads = UploadFolder::open(folder.path()).value();
  const Asker ann{.name = "ann"}, bob{.name = "bob"}, eve{.name = "eve"};
  const auto anns =
      uploads->keep(body(folder.path(), "bytes").fd(), "x.tif", {.owner = "ann", .at_ms = 10}).value();
  const auto bobs =
      uploads->keep(body(folder.path(), "bytes").fd(), "units.geojson", {.owner = "bob", .at_ms = 20})
          .value();
  EXPECT_EQ(anns.id, bobs.id);
  EXPECT_EQ(bobs.name, "units.geojson");
  EXPECT_EQ(uploads->find(bobs.id, ann)->name, "x.tif");
  EXPECT_EQ(uploads->verified(bobs.id, bob)->filename(), "units.geojson");
  EXPECT_TRUE(uploads->find(bobs.id, eve)) << "as before, who knows the bytes may work on them";
  EXPECT_EQ(fs::hard_link_count(*uploads->verified(bobs.id, bob)), 2U) << "the bytes are there once";
  EXPECT_EQ(uploads->list(bob).size(), 1U);
  EXPECT_EQ(uploads->list(bob).front().name, "units.geojson");
  EXPECT_TRUE(*uploads->remove(anns));
  EXPECT_EQ(uploads->find(bobs.id, ann)->origin.owner, "bob");
  EXPECT_EQ(uploads->verified(bobs.id, bob)->filename(), "units.geojson") << "ann's alone is gone";
}

TEST(UploadFolder, AnUploadFromBeforeOwnersHadTheirOwnIsItsOwners) {
  const ScratchFolder folder;
  auto uploads = UploadFolder::open(folder.path()).value();
  const auto made =
      uploads->keep(body(folder.path(), "bytes").fd(), "a.csv", {.owner = "ann", .at_ms = 10}).value();
  fs::rename(uploads->files() / made.folder, uploads->files() / made.id);
  EXPECT_EQ(uploads->find(made.id, {.name = "ann"})->folder, made.id);
  EXPECT_EQ(uploads->keep(body(folder.path(), "bytes").fd(), "b.csv", {.owner = "ann", .at_ms = 20})->name,
            "a.csv");
}

TEST(UploadFolder, HoldsNoMoreThanItMay) {
  const ScratchFolder folder;
  auto uploads = UploadFolder::open(folder.path(), {.max_total_bytes = 1000}).value();
  const std::int64_t before = uploads->room();
  ASSERT_TRUE(uploads->keep(body(folder.path(), std::string(500, 'a')).fd(), "a", {}));
  EXPECT_LE(uploads->room(), before - 500) << "what an archive may unpack to";
  EXPECT_LE(uploads->room(), 500);
  const auto second = uploads->keep(body(folder.path(), std::string(500, 'b')).fd(), "b", {});
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::kStorageFull);
  EXPECT_EQ(uploads->list().size(), 1U);
}

TEST(UploadFolder, AFileWithTwoNamesCountsOnceAndABodyThatIsComingNotAtAll) {
  const ScratchFolder scratch;
  const auto folder = UploadFolder::open(scratch.path()).value();
  const auto kept = folder->keep(body(folder->files(), std::string(1000, 'x')).fd(), "a.bin", {.at_ms = 1});
  ASSERT_TRUE(kept) << kept.error().detail;
  const std::int64_t before = folder->bytes();
  fs::create_directories(folder->terrains() / "site");
  fs::create_hard_link(folder->verified(kept->id).value(), folder->terrains() / "site" / "b.bin");
  testing::write_file(folder->files() / ".body-AbCdEf", std::string(500, 'y'));
  EXPECT_EQ(folder->bytes(), before);
  EXPECT_EQ(folder->list().size(), 1U);
}

}  // namespace
}  // namespace slipway::api
