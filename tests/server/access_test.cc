#include "server/operations/access.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace slipway::server {
namespace {

// A file of tokens that is gone with the test.
class TokenFile {
 public:
  explicit TokenFile(const std::string& text)
      : path_(::testing::TempDir() + "tokens_" +
              ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".toml") {
    std::ofstream(path_) << text;
  }
  ~TokenFile() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

HttpRequest asked(const std::string& method, const std::string& token, const std::string& path = "/v1/jobs") {
  HttpRequest request;
  request.method = method;
  request.path = path;
  request.remote_address = "10.0.0.7";
  if (!token.empty()) request.headers.emplace_back("Authorization", "Bearer " + token);
  return request;
}

TEST(Access, ATokenIsOnePersons) {
  const NewToken one = new_token("ann", Role::kOperator);
  std::string again = one.entry;
  again.replace(again.find("ann"), 3, "bob");
  const TokenFile file(one.entry + again);
  const auto refused = Access::open({.tokens = file.path()});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().faults.front().message.find("same token"), std::string::npos);
}

ErrorCode refusal_of(Access& access, HttpRequest request) {
  const auto admitted = access.admit(request);
  return admitted ? ErrorCode::kInternal : admitted.error().code;
}

TEST(Access, RolesMayDoWhatTheyMay) {
  const NewToken viewer = new_token("wall", Role::kViewer), worker = new_token("ops", Role::kOperator),
                 admin = new_token("root", Role::kAdmin);
  const TokenFile file(viewer.entry + worker.entry + admin.entry);
  const auto access = Access::open({.tokens = file.path()});
  ASSERT_TRUE(access) << access.error().detail;
  HttpRequest reads = asked("GET", viewer.token), asks = asked("POST", worker.token),
              all = asked("DELETE", admin.token);
  EXPECT_TRUE((*access)->admit(reads));
  EXPECT_EQ(reads.principal, "wall");
  EXPECT_TRUE((*access)->admit(asks));
  EXPECT_EQ(asks.principal, "ops");
  EXPECT_TRUE((*access)->knows(asks.token));
  EXPECT_FALSE((*access)->knows(""));
  EXPECT_FALSE(asks.is_admin);
  EXPECT_TRUE((*access)->admit(all));
  EXPECT_TRUE(all.is_admin);
  EXPECT_EQ(refusal_of(**access, asked("POST", viewer.token)), ErrorCode::kForbidden);
  EXPECT_EQ(refusal_of(**access, asked("GET", "")), ErrorCode::kUnauthorized);
  EXPECT_EQ(refusal_of(**access, asked("GET", viewer.token + "0")), ErrorCode::kUnauthorized);
  HttpRequest health = asked("GET", "", "/healthz"), preflight = asked("OPTIONS", "");
  EXPECT_TRUE((*access)->admit(health)) << "whether there is anybody is no secret";
  EXPECT_TRUE((*access)->admit(preflight)) << "browsers send no token with it";
  HttpRequest page = asked("GET", "", "/dashboard/");
  EXPECT_TRUE((*access)->admit(page)) << "it asks for the token itself";
  EXPECT_EQ(refusal_of(**access, asked("GET", "", "/dashboards")), ErrorCode::kUnauthorized);
}

TEST(Access, WhomItRefusesIsKnownFromTheHead) {
  const NewToken viewer = new_token("wall", Role::kViewer), worker = new_token("ops", Role::kOperator);
  const TokenFile file(viewer.entry + worker.entry);
  const auto access = Access::open({.tokens = file.path(), .max_requests_per_s = 1.0});
  ASSERT_TRUE(access) << access.error().detail;
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE((*access)->refuses("POST", "/v1/uploads", std::nullopt));
    EXPECT_TRUE((*access)->refuses("POST", "/v1/uploads", "Bearer " + viewer.token));
    EXPECT_TRUE((*access)->refuses("POST", "/v1/uploads", "Bearer nonsense"));
    EXPECT_FALSE((*access)->refuses("POST", "/v1/uploads", "bearer " + worker.token)) << "no rate is counted";
  }
  EXPECT_EQ((*access)->name_of("GET", "/v1/jobs", "Bearer " + viewer.token), "wall");
  EXPECT_EQ((*access)->name_of("GET", "/v1/jobs", "Bearer nonsense"), "") << "nobody makes names up";
}

TEST(Access, NoTokenIsInTheFile) {
  const NewToken made = new_token("ops", Role::kOperator);
  EXPECT_EQ(made.token.size(), 64u);
  EXPECT_EQ(made.entry.find(made.token), std::string::npos);
  EXPECT_NE(made.token, new_token("ops", Role::kOperator).token);
}

TEST(Access, EveryFaultOfTheFileIsNamed) {
  const TokenFile file(
      "[[tokens]]\nname = \"a\"\nrole = \"king\"\nsha256 = \"00\"\n[[tokens]]\nname = \"b\"\nrole = "
      "\"viewer\"\n"
      "sha256 = \"" +
      std::string(64, 'G') + "\"\nmore = 1\n");
  const auto access = Access::open({.tokens = file.path()});
  ASSERT_FALSE(access);
  std::string pointers;
  for (const Fault& fault : access.error().faults) pointers += fault.pointer + " ";
  EXPECT_EQ(pointers, "/tokens/0/role /tokens/1/more /tokens/1/sha256 ");
  EXPECT_FALSE(Access::open({.tokens = "/no/such/file"}));
}

TEST(Access, AFileThatIsReadAgainHoldsAtOnceAndABrokenOneChangesNothing) {
  const NewToken stays = new_token("ops", Role::kOperator), goes = new_token("wall", Role::kViewer);
  const TokenFile file(stays.entry + goes.entry);
  const auto access = Access::open({.tokens = file.path()});
  ASSERT_TRUE(access) << access.error().detail;
  HttpRequest request = asked("GET", goes.token);
  EXPECT_TRUE((*access)->admit(request));
  std::ofstream(file.path()) << stays.entry;
  ASSERT_EQ((*access)->read_again().value_or(0), 1u);
  EXPECT_EQ(refusal_of(**access, asked("GET", goes.token)), ErrorCode::kUnauthorized);
  std::ofstream(file.path()) << "[[tokens]]\nname = ";
  EXPECT_FALSE((*access)->read_again());
  HttpRequest again = asked("GET", stays.token);
  EXPECT_TRUE((*access)->admit(again));
}

TEST(Access, WithoutTokensTheAddressAsks) {
  const auto access = Access::open({});
  HttpRequest request = asked("DELETE", "");
  EXPECT_TRUE((*access)->admit(request));
  EXPECT_EQ(request.principal, "10.0.0.7");
}

TEST(Access, WhoAsksTooOftenWaitsAndShutsOutNobodyElse) {
  const auto access = Access::open({.max_requests_per_s = 5.0});
  int admitted = 0;
  for (int k = 0; k < 50; ++k) {
    HttpRequest request = asked("GET", "");
    admitted += (*access)->admit(request) ? 1 : 0;
  }
  EXPECT_GE(admitted, 5);
  EXPECT_LE(admitted, 10);
  HttpRequest other = asked("GET", "");
  other.remote_address = "10.0.0.8";
  EXPECT_TRUE((*access)->admit(other));
  EXPECT_EQ(refusal_of(**access, asked("GET", "")), ErrorCode::kTooManyRequests);
}

}  // namespace
}  // namespace slipway::server
