#include "server/operations/log.h"

#include <gtest/gtest.h>

#include "api/json/parse.h"

namespace slipway::server {
namespace {

std::string written(LogForm form, LogLevel from, LogLevel level) {
  ::testing::internal::CaptureStderr();
  set_log(form, from);
  log_event(level, "worker_died", {{"reason", "signal 9\n\x1b[31m\"quoted\""}, {"jobs", 1.0}});
  return ::testing::internal::GetCapturedStderr();
}

TEST(Log, AnEventIsOneJsonObjectALine) {
  const std::string line = written(LogForm::kJson, LogLevel::kInfo, LogLevel::kWarning);
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  const auto event = api::json::parse(line);
  ASSERT_TRUE(event) << line;
  EXPECT_EQ(event->find("level")->text, "warning");
  EXPECT_EQ(event->find("event")->text, "worker_died");
  EXPECT_EQ(event->find("reason")->text, "signal 9\n\x1b[31m\"quoted\"");
  EXPECT_EQ(event->find("jobs")->number, 1.0);
  EXPECT_EQ(event->find("time")->text.size(), std::string("2026-11-23T07:00:00.000Z").size());
}

TEST(Log, AsTextItIsOneLineThatNoTerminalActsOn) {
  const std::string line = written(LogForm::kText, LogLevel::kInfo, LogLevel::kWarning);
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  EXPECT_EQ(line.find('\x1b'), std::string::npos);
  EXPECT_NE(line.find("warning worker_died reason=\"signal 9"), std::string::npos) << line;
}

TEST(Log, WhatIsBelowTheLevelIsNotWritten) {
  EXPECT_EQ(written(LogForm::kText, LogLevel::kError, LogLevel::kWarning), "");
}

TEST(Log, ATraceIdIsTakenFromASoundHeaderAlone) {
  EXPECT_EQ(trace_id_of("00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"),
            "4bf92f3577b34da6a3ce929d0e0e4736");
  for (const char* bad : {"", "00-4bf9", "00-00000000000000000000000000000000-00f067aa0ba902b7-01",
                          "00-4BF92F3577B34DA6A3CE929D0E0E4736-00f067aa0ba902b7-01"})
    EXPECT_EQ(trace_id_of(bad), std::nullopt) << bad;
}

}  // namespace
}  // namespace slipway::server
