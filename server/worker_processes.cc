#include "server/worker_processes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/eventfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "api/jobs/job.h"
#include "core/file_descriptor.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX declares it nowhere

namespace slipway::server {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

struct Pipe {
  FileDescriptor out, in;
};

std::optional<Pipe> make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return std::nullopt;
  return Pipe{FileDescriptor(ends[0]), FileDescriptor(ends[1])};
}

// What the child gets: the pipes as standard input and output, no other file of ours, no signal blocked.
class SpawnSettings {
 public:
  SpawnSettings(int input, int output) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    posix_spawn_file_actions_addclosefrom_np(&actions_, STDERR_FILENO + 1);
    posix_spawnattr_init(&attributes_);
    sigset_t none, usual;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes_, &none);
    sigemptyset(&usual);
    sigaddset(&usual, SIGPIPE);
    posix_spawnattr_setsigdefault(&attributes_, &usual);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  const posix_spawn_file_actions_t* actions() const { return &actions_; }
  const posix_spawnattr_t* attributes() const { return &attributes_; }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

std::string words_of(int status) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    const char* const what = ::strsignal(signal);
    return fmt::format("the worker was ended by signal {} ({})", signal, what == nullptr ? "unknown" : what);
  }
  return fmt::format("the worker ended by itself with status {}", WEXITSTATUS(status));
}

}  // namespace

class WorkerProcesses::Supervisor {
 public:
  Supervisor(WorkerProcessOptions options, std::function<void()> on_bell,
             std::function<void(const std::string&, const std::string&)> on_death)
      : options_(std::move(options)), on_bell_(std::move(on_bell)), on_death_(std::move(on_death)) {
    for (const std::vector<std::string>& command : options_.commands) {
      Worker& worker = workers_.emplace_back();
      worker.command = command;
      worker.pause = options_.first_pause;
    }
  }
  ~Supervisor() { stop(); }

  Result<void> start() {
    wake_ = FileDescriptor(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC));
    for (Worker& worker : workers_)
      if (const auto begun = begin(worker); !begun) return begun;
    thread_ = std::thread([this] { watch(); });
    return {};
  }

  void stop() {
    {
      const std::scoped_lock lock(mutex_);
      if (std::exchange(stopping_, true)) return;
      for (Worker& worker : workers_) worker.bell.close();
    }
    wake();
    if (thread_.joinable()) thread_.join();
    const Clock::time_point until = Clock::now() + options_.patience;
    for (Worker& worker : workers_) end(worker, until);
  }

  void ring() {
    const std::scoped_lock lock(mutex_);
    for (const Worker& worker : workers_)
      if (worker.bell.is_open())
        static_cast<void>(::write(worker.bell.fd(), "\n", 1));  // full: it rings already
  }

  std::optional<std::string> shortage() const {
    const std::scoped_lock lock(mutex_);
    const auto missing =
        std::count_if(workers_.begin(), workers_.end(), [](const Worker& w) { return !w.has_rung; });
    if (missing == 0) return std::nullopt;
    return fmt::format(
        "{} of {} workers {} not started, and each is started again{}", missing, workers_.size(),
        missing == 1 ? "has" : "have",
        last_death_.empty() ? "" : fmt::format(" ({}; the service's log has what it said)", last_death_));
  }

 private:
  struct Worker {
    std::vector<std::string> command;
    std::string name;
    pid_t pid = 0;          // 0: does not run
    FileDescriptor bell;    // its standard input
    FileDescriptor heard;   // its standard output
    bool has_rung = false;  // since it began
    Clock::time_point begun;
    Clock::time_point starts_again;  // where it does not run
    milliseconds pause{0};           // before the next start
  };

  void wake() const {
    const std::uint64_t one = 1;
    static_cast<void>(::write(wake_.fd(), &one, sizeof one));
  }

  Result<void> begin(Worker& worker) {
    auto to_worker = make_pipe(), from_worker = make_pipe();
    if (!to_worker || !from_worker)
      return fail(ErrorCode::kInternal, std::string("a pipe to a worker: ") + std::strerror(errno));
    worker.name = fmt::format("{}/{}", options_.family, api::new_job_id());
    std::vector<std::string> command = worker.command;
    std::vector<char*> argv;
    for (std::string& word : command) {
      if (word == "{name}") word = worker.name;
      argv.push_back(word.data());
    }
    argv.push_back(nullptr);
    const SpawnSettings settings(to_worker->out.fd(), from_worker->in.fd());
    const int failed = ::posix_spawn(&worker.pid, argv.front(), settings.actions(), settings.attributes(),
                                     argv.data(), environ);
    if (failed != 0) {
      worker.pid = 0;
      return fail(ErrorCode::kInternal,
                  fmt::format("a worker process does not start: {}", std::system_category().message(failed)));
    }
    ::fcntl(to_worker->in.fd(), F_SETFL, O_NONBLOCK);
    const std::scoped_lock lock(mutex_);
    if (stopping_) return {};  // the pipe closes here, and the worker ends
    worker.bell = std::move(to_worker->in);
    worker.heard = std::move(from_worker->out);
    worker.begun = Clock::now();
    return {};
  }

  // One worker's end was seen: tells, and says when it is to begin again.
  void bury(Worker& worker) {
    int status = 0;
    while (::waitpid(worker.pid, &status, 0) < 0 && errno == EINTR) {
    }
    const Clock::time_point now = Clock::now();
    constexpr milliseconds kLong{10'000};  // a worker that ran so long is not one that can't begin
    if (now - worker.begun > kLong) worker.pause = options_.first_pause;
    worker.starts_again = now + worker.pause;
    worker.pause = std::min(2 * worker.pause, options_.longest_pause);
    worker.pid = 0;
    {
      const std::scoped_lock lock(mutex_);
      worker.bell.close();
      worker.heard.close();
      worker.has_rung = false;
      last_death_ = words_of(status);
      if (stopping_) return;
    }
    on_death_(worker.name, words_of(status));
  }

  // Until stop(): hears bells, sees deaths and starts again what died.
  void watch() {
    while (!is_stopping()) {
      std::vector<pollfd> polled{{wake_.fd(), POLLIN, 0}};
      std::vector<Worker*> of;
      Clock::time_point next = Clock::now() + std::chrono::hours(1);
      for (Worker& worker : workers_) {
        if (worker.pid == 0) {
          next = std::min(next, worker.starts_again);
          continue;
        }
        polled.push_back({worker.heard.fd(), POLLIN, 0});
        of.push_back(&worker);
      }
      const auto left = std::chrono::ceil<milliseconds>(next - Clock::now()).count();
      ::poll(polled.data(), polled.size(), static_cast<int>(std::max<std::int64_t>(left, 0)));
      if (is_stopping()) return;
      for (std::size_t k = 0; k < of.size(); ++k)
        if (polled[k + 1].revents != 0) hear(*of[k]);
      for (Worker& worker : workers_)
        if (worker.pid == 0 && Clock::now() >= worker.starts_again && !begin(worker))
          worker.starts_again = Clock::now() + options_.longest_pause;
    }
  }

  void hear(Worker& worker) {
    std::array<char, 256> bytes{};
    const ssize_t count = ::read(worker.heard.fd(), bytes.data(), bytes.size());
    if (count == 0) bury(worker);
    if (count <= 0) return;
    {
      const std::scoped_lock lock(mutex_);
      worker.has_rung = true;
    }
    on_bell_();
  }

  bool is_stopping() const {
    const std::scoped_lock lock(mutex_);
    return stopping_;
  }

  static void end(Worker& worker, Clock::time_point until) {
    if (worker.pid == 0) return;
    constexpr milliseconds kPause{20};
    for (int status = 0; ::waitpid(worker.pid, &status, WNOHANG) == 0; std::this_thread::sleep_for(kPause)) {
      if (Clock::now() < until) continue;
      ::kill(worker.pid, SIGKILL);
      ::waitpid(worker.pid, &status, 0);
      break;
    }
    worker.pid = 0;
  }

  const WorkerProcessOptions options_;
  const std::function<void()> on_bell_;
  const std::function<void(const std::string&, const std::string&)> on_death_;
  FileDescriptor wake_;
  mutable std::mutex mutex_;  // stopping_, last_death_, the bells of workers_: the rest is the thread's
  bool stopping_ = false;
  std::string last_death_;
  std::vector<Worker> workers_;
  std::thread thread_;
};

WorkerProcesses::WorkerProcesses(WorkerProcessOptions options, std::function<void()> on_bell,
                                 std::function<void(const std::string&, const std::string&)> on_death)
    : supervisor_(std::make_unique<Supervisor>(std::move(options), std::move(on_bell), std::move(on_death))) {
}

WorkerProcesses::~WorkerProcesses() = default;

Result<void> WorkerProcesses::start() {
  return supervisor_->start();
}

void WorkerProcesses::stop() {
  supervisor_->stop();
}

void WorkerProcesses::ring() {
  supervisor_->ring();
}

std::optional<std::string> WorkerProcesses::shortage() const {
  return supervisor_->shortage();
}

}  // namespace slipway::server
