#include "server/operations/audit_log.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace slipway::server {
namespace {

class AuditLogTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove(path_); }
  void TearDown() override { std::filesystem::remove(path_); }

  std::unique_ptr<AuditLog> open() { return AuditLog::open(path_).value(); }
  void record(AuditLog& log, const std::string& who, int status, const std::string& path = "/v1/jobs/1") {
    HttpRequest request;
    request.method = "DELETE";
    request.path = path;
    request.principal = request.remote_address = who;
    HttpResponse response;
    response.status = status;
    log.record({request, response});
  }
  std::vector<std::string> lines() const {
    std::vector<std::string> all;
    std::ifstream file(path_);
    for (std::string line; std::getline(file, line);) all.push_back(line);
    return all;
  }

  const std::string path_ =
      ::testing::TempDir() + "audit_" + ::testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(AuditLogTest, WhoIsNotLetInHasALineAndACount) {
  {
    const auto log = open();
    for (int k = 0; k < 6000; ++k) record(*log, k % 2 == 0 ? "10.0.0.1" : "10.0.0.2", 401);
    for (int k = 0; k < 3; ++k) record(*log, "ann", 404);
    EXPECT_EQ(lines().size(), 5U);
  }
  ASSERT_EQ(lines().size(), 7U) << "the counts come with the end";
  EXPECT_NE(lines()[5].find("\"who\":\"10.0.0.1\",\"status\":401,\"more\":2999"), std::string::npos)
      << lines()[5];
}

TEST_F(AuditLogTest, ManyAddressesAreOthers) {
  const auto log = open();
  for (int k = 0; k < 5000; ++k) record(*log, "10.0." + std::to_string(k), 401);
  EXPECT_LE(lines().size(), 1001U);
}

TEST_F(AuditLogTest, ATornLineIsEndedBeforeTheNext) {
  std::ofstream(path_) << "{\"whole\":1}\n{\"torn";
  record(*open(), "ann", 204);
  ASSERT_EQ(lines().size(), 3U);
  EXPECT_EQ(lines()[1], "{\"torn");
  EXPECT_TRUE(lines()[2].starts_with("{\"time\"")) << lines()[2];
}

TEST_F(AuditLogTest, WhatTurnsOrHidesTextIsEscaped) {
  record(*open(), "ann", 204, "/v1/\xe2\x80\xae\xe2\x80\xa8\x7f\xc3\xa4");
  EXPECT_NE(lines().front().find("/v1/\\u202e\\u2028\\u007f\xc3\xa4"), std::string::npos) << lines().front();
}

}  // namespace
}  // namespace slipway::server
