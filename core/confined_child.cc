#include "core/confined_child.h"

#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

#include "core/process_limits.h"

namespace slipway {
namespace {

using Clock = std::chrono::steady_clock;

// What the child tells: a letter, the count of bytes, the bytes.
constexpr char kStage = 'P', kAnswer = 'A', kError = 'E';
constexpr int kOutOfMemory = 97;  // exit status of a child whose memory is spent

void put_number(std::string& out, std::uint64_t value) {
  std::array<char, 8> bytes{};
  std::memcpy(bytes.data(), &value, bytes.size());
  out.append(bytes.data(), bytes.size());
}

void put_text(std::string& out, const std::string& text) {
  put_number(out, text.size());
  out += text;
}

// Takes numbers and texts from the front.
class Taker {
 public:
  explicit Taker(std::string_view bytes) : bytes_(bytes) {}
  std::uint64_t number() {
    std::uint64_t value = 0;
    if (bytes_.size() < sizeof value) return 0;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return value;
  }
  std::string text() {
    const std::size_t size = std::min<std::size_t>(number(), bytes_.size());
    std::string text(bytes_.substr(0, size));
    bytes_.remove_prefix(size);
    return text;
  }

 private:
  std::string_view bytes_;
};

std::string bytes_of(const Error& error) {
  std::string out;
  put_number(out, static_cast<std::uint64_t>(error.code));
  put_text(out, error.detail);
  put_number(out, error.faults.size());
  for (const Fault& fault : error.faults) {
    put_text(out, fault.pointer);
    put_text(out, fault.message);
  }
  return out;
}

Error error_from(std::string_view bytes) {
  Taker from(bytes);
  Error error;
  error.code = static_cast<ErrorCode>(from.number());
  error.detail = from.text();
  const std::uint64_t count = from.number();
  for (std::uint64_t i = 0; i < count; ++i) {
    std::string pointer = from.text();
    error.faults.push_back({std::move(pointer), from.text()});
  }
  return error;
}

void tell(int pipe, char letter, const std::string& text) {
  std::string message(1, letter);
  put_text(message, text);
  for (std::size_t sent = 0; sent < message.size();) {
    const ssize_t count = ::write(pipe, message.data() + sent, message.size() - sent);
    if (count < 0 && errno != EINTR) _exit(1);  // nobody listens any more
    if (count > 0) sent += static_cast<std::size_t>(count);
  }
}

// Tells the parent at most ten times a second.
class ToldProgress final : public Progress {
 public:
  explicit ToldProgress(int pipe) : pipe_(pipe) {}
  void report(std::string_view stage, double fraction) override {
    if (const auto now = Clock::now(); now - last_ >= std::chrono::milliseconds(100) || stage != stage_) {
      last_ = now;
      stage_ = stage;
      std::string text;
      put_number(text, static_cast<std::uint64_t>(std::clamp(fraction, 0.0, 1.0) * 1e6));
      tell(pipe_, kStage, text + std::string(stage));
    }
  }
  bool cancelled() const override { return false; }  // the parent kills

 private:
  int pipe_;
  Clock::time_point last_{};
  std::string stage_;
};

void confine(const ChildLimits& limits) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::signal(SIGINT, SIG_IGN);  // the parent hears it and kills
  std::signal(SIGTERM, SIG_DFL);
  std::signal(SIGPIPE, SIG_IGN);
  leave_no_core();
  limit_memory(static_cast<double>(limits.max_memory_bytes));
  const auto seconds = static_cast<rlim_t>(std::ceil(limits.max_time_s));
  const rlimit of_processor{seconds, seconds};
  ::setrlimit(RLIMIT_CPU, &of_processor);
  // With the right to make a network namespace no user namespace is needed, in which files of others are
  // out of reach. Where neither is allowed, the fence around the libraries holds alone.
  if (::unshare(CLONE_NEWNET) != 0) static_cast<void>(::unshare(CLONE_NEWUSER | CLONE_NEWNET));
}

[[noreturn]] void be_the_child(int pipe, const ChildLimits& limits,
                               const std::function<Result<std::string>(Progress&)>& work) {
  confine(limits);
  try {
    ToldProgress progress(pipe);
    const auto answer = work(progress);
    tell(pipe, answer ? kAnswer : kError, answer ? *answer : bytes_of(answer.error()));
    _exit(0);
  } catch (const std::bad_alloc&) {
    _exit(kOutOfMemory);
  } catch (const std::exception& broken) {
    tell(pipe, kError, bytes_of({ErrorCode::kInternal, broken.what(), {}}));
    _exit(0);
  }
}

// Gathers what the child tells, and its end.
class Listener {
 public:
  Listener(int pipe, Progress& progress) : pipe_(pipe), progress_(progress) {}

  // False when the child has closed its end.
  bool listen(int wait_ms) {
    pollfd ready{pipe_, POLLIN, 0};
    if (::poll(&ready, 1, wait_ms) <= 0) return true;
    std::array<char, 4096> piece{};
    const ssize_t count = ::read(pipe_, piece.data(), piece.size());
    if (count < 0) return errno == EINTR;
    gathered_.append(piece.data(), static_cast<std::size_t>(count));
    take_messages();
    return count > 0;
  }
  std::optional<Result<std::string>> answer;

 private:
  void take_messages() {
    for (;;) {
      if (gathered_.size() < 9) return;
      const std::uint64_t size = Taker(std::string_view(gathered_).substr(1, 8)).number();
      if (gathered_.size() - 9 < size) return;
      take(gathered_.front(), gathered_.substr(9, size));
      gathered_.erase(0, 9 + size);
    }
  }
  void take(char letter, const std::string& text) {
    if (letter == kStage && text.size() >= 8)
      progress_.report(text.substr(8), static_cast<double>(Taker(text).number()) / 1e6);
    if (letter == kAnswer) answer = Result<std::string>(text);
    if (letter == kError) answer = Result<std::string>(fail(error_from(text)));
  }

  int pipe_;
  Progress& progress_;
  std::string gathered_;
};

tl::unexpected<Error> untold_end(int status, const ChildLimits& limits) {
  const bool cpu = WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemory)
    return fail(ErrorCode::kPayloadTooLarge,
                fmt::format("The work needs more than the {} MB of memory that it may have.",
                            limits.max_memory_bytes / 1'000'000));
  if (cpu)
    return fail(
        ErrorCode::kPayloadTooLarge,
        fmt::format("The work was ended by the system at {:.0f} s of a core's time, or for want of memory.",
                    limits.max_time_s));
  return fail(ErrorCode::kInternal,
              WIFSIGNALED(status)
                  ? fmt::format("The process that did the work crashed (signal {}).", WTERMSIG(status))
                  : std::string("The process that did the work ended without an answer."));
}

}  // namespace

Result<std::string> run_confined(const ChildLimits& limits,
                                 const std::function<Result<std::string>(Progress&)>& work,
                                 Progress& progress) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return fail(ErrorCode::kInternal, "no pipe to a child process can be made");
  const pid_t child = ::fork();
  if (child < 0) {
    ::close(ends[0]);
    ::close(ends[1]);
    return fail(ErrorCode::kInternal, "no child process can be made");
  }
  if (child == 0) {
    ::close(ends[0]);
    be_the_child(ends[1], limits, work);
  }
  ::close(ends[1]);
  Listener listener(ends[0], progress);
  const auto deadline = Clock::now() + std::chrono::duration<double>(limits.max_time_s);
  bool late = false, given_up = false;
  while (!late && !given_up && listener.listen(50)) {
    late = Clock::now() >= deadline;
    given_up = progress.cancelled();
  }
  // A child that has answered has ended, or is about to.
  if (late || given_up) ::kill(child, SIGKILL);
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (given_up || (!listener.answer && progress.cancelled()))
    return fail(ErrorCode::kCancelled, "The work was given up.");
  if (listener.answer) return *std::move(listener.answer);
  if (late)
    return fail(ErrorCode::kPayloadTooLarge,
                fmt::format("The work takes more than the {:.0f} s that it may have.", limits.max_time_s));
  return untold_end(status, limits);
}

}  // namespace slipway
