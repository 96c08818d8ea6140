#include "core/confined_child.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>
#include <vector>

namespace slipway {
namespace {

class Heard final : public Progress {
 public:
  explicit Heard(bool cancels_at_once = false) : cancels_(cancels_at_once) {}
  void report(std::string_view stage, double fraction) override {
    stage_ = stage;
    fraction_ = fraction;
  }
  bool cancelled() const override { return cancels_; }
  std::string stage_;
  double fraction_ = 0.0;

 private:
  bool cancels_;
};

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

Result<std::string> sleep_long(Progress& /*progress*/) {
  std::this_thread::sleep_for(std::chrono::seconds(60));
  return std::string("rested");
}

TEST(ConfinedChild, AnswersTellsItsProgressAndChangesNothingHere) {
  Heard heard;
  int here = 1;
  const std::string large(200'000, 'x');
  const auto answer = run_confined(
      {},
      [&](Progress& progress) -> Result<std::string> {
        here = 2;
        progress.report("half way", 0.5);
        return large + '\0' + "end";
      },
      heard);
  ASSERT_TRUE(answer);
  EXPECT_EQ(*answer, large + '\0' + "end");
  EXPECT_EQ(heard.stage_, "half way");
  EXPECT_DOUBLE_EQ(heard.fraction_, 0.5);
  EXPECT_EQ(here, 1);
}

TEST(ConfinedChild, AnErrorComesWithAllItsFaults) {
  NoProgress quiet;
  const auto answer = run_confined(
      {},
      [](Progress&) -> Result<std::string> {
        return fail(ErrorCode::kUnsupportedCrs, "two reasons", {{"a", "first"}, {"b", "second"}});
      },
      quiet);
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kUnsupportedCrs);
  EXPECT_EQ(answer.error().detail, "two reasons");
  EXPECT_EQ(answer.error().faults, (std::vector<Fault>{{"a", "first"}, {"b", "second"}}));
}

TEST(ConfinedChild, TooMuchMemoryIsRefusedAndACrashIsTold) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  NoProgress quiet;
  const auto large = run_confined(
      {.max_memory_bytes = 512LL << 20U},
      [](Progress&) -> Result<std::string> {
        return std::string(std::vector<char>(std::size_t{1} << 30U, 'x').data(), 1);
      },
      quiet);
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, ErrorCode::kPayloadTooLarge);
  const auto crashed = run_confined(
      {},
      [](Progress&) -> Result<std::string> {
        std::signal(SIGABRT, SIG_DFL);
        std::abort();
      },
      quiet);
  ASSERT_FALSE(crashed);
  EXPECT_NE(crashed.error().detail.find("crashed (signal 6)"), std::string::npos) << crashed.error().detail;
#endif
}

TEST(ConfinedChild, TheDeadlineAndACancellationEndIt) {
  NoProgress quiet;
  auto begin = std::chrono::steady_clock::now();
  const auto late = run_confined({.max_time_s = 0.3}, &sleep_long, quiet);
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, ErrorCode::kPayloadTooLarge);
  Heard cancels(true);
  const auto given_up = run_confined({}, &sleep_long, cancels);
  ASSERT_FALSE(given_up);
  EXPECT_EQ(given_up.error().code, ErrorCode::kCancelled);
  EXPECT_LT(seconds_since(begin), 10.0);
}

// Whether this process reaches a socket that listens on this machine.
bool reaches(std::uint16_t port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  if (socket < 0) return false;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = port;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const bool connected = ::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  ::close(socket);
  return connected;
}

TEST(ConfinedChild, HasNoNetworkWhereTheSystemAllowsThat) {
  const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(::listen(listener, 1), 0);
  socklen_t size = sizeof address;
  ::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
  ASSERT_TRUE(reaches(address.sin_port));
  NoProgress quiet;
  const auto answer = run_confined(
      {},
      [&](Progress&) -> Result<std::string> {
        char name[64] = {};
        const auto length = ::readlink("/proc/self/ns/net", name, sizeof name - 1);
        return std::string(name, length > 0 ? static_cast<std::size_t>(length) : 0) +
               (reaches(address.sin_port) ? " reached" : " cut off");
      },
      quiet);
  ::close(listener);
  ASSERT_TRUE(answer);
  char own[64] = {};
  const auto length = ::readlink("/proc/self/ns/net", own, sizeof own - 1);
  if (answer->starts_with(std::string(own, length > 0 ? static_cast<std::size_t>(length) : 0) + " "))
    GTEST_SKIP() << "this system gives no network namespace";
  EXPECT_NE(answer->find("cut off"), std::string::npos);
}

}  // namespace
}  // namespace slipway
