#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <string>

#include "core/boot_clock.h"
#include "core/version.h"

namespace slipway {
namespace {

TEST(BuildId, IsWhatTheLinkerWroteIntoThisProgram) {
  const std::string& id = build_id();
  EXPECT_EQ(id.size(), 40U) << id;
  EXPECT_TRUE(std::all_of(id.begin(), id.end(), [](unsigned char c) { return std::isxdigit(c) != 0; })) << id;
  const std::string command = "readelf -n /proc/" + std::to_string(::getpid()) + "/exe 2>&1";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string notes;
  for (int c; (c = std::fgetc(pipe)) != EOF;) notes += static_cast<char>(c);
  ::pclose(pipe);
  EXPECT_NE(notes.find("Build ID: " + id), std::string::npos) << notes;
}

TEST(BootClock, OnlyGoesOnAndNamesOneStartOfTheMachine) {
  const std::int64_t before = boot_ms();
  EXPECT_GT(before, 0);
  EXPECT_GE(boot_ms(), before);
  EXPECT_FALSE(boot_id().empty());
  EXPECT_EQ(boot_id(), boot_id());
}

}  // namespace
}  // namespace slipway
