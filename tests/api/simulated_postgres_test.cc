// The store of jobs on a database server, to which connections break: before a request has come there, and
// after it while the answer is on its way.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "api/jobs/postgres_job_store.h"
#include "postgres_schema.h"
#include "simulated_jobs.h"

namespace slipway::api {
namespace {

enum class Mishap {
  kUnheard,     // the request does not come to the server, and the connection breaks
  kUnanswered,  // the server does what it is asked, and the connection breaks
  kDeath,       // of the process, after its request
  kRestart,     // all connections of all processes break, after this request
  kNone,
};

// A socket that ends with it.
class Socket {
 public:
  explicit Socket(int fd) : fd_(fd) {
    if (fd < 0) throw std::runtime_error("no socket");
  }
  ~Socket() { ::close(fd_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return address;
}

// Between one process and the server, whose bytes it carries on. `befalls` says of each request what does.
class Wire {
 public:
  Wire(int server_port, std::function<Mishap()> befalls)
      : server_port_(server_port),
        befalls_(std::move(befalls)),
        listening_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address = loopback(0);
    socklen_t size = sizeof address;
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    if (::bind(listening_.fd(), any, size) != 0 || ::listen(listening_.fd(), 16) != 0 ||
        ::getsockname(listening_.fd(), any, &size) != 0)
      throw std::runtime_error("no port for the simulated wire");
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { carry(); });
  }
  ~Wire() {
    ended_ = true;
    thread_.join();
  }
  int port() const { return port_; }
  void die() { dead_ = true; }
  bool is_dead() const { return dead_; }
  void cut() { cut_ = true; }

 private:
  struct Line {
    std::unique_ptr<Socket> client, server;  // the client's null: its end is broken, the answer is not heard
  };

  void carry() {
    while (!ended_) {
      if (cut_.exchange(false) || dead_) lines_.clear();
      std::vector<pollfd> waited{{listening_.fd(), POLLIN, 0}};
      for (const Line& line : lines_) {
        waited.push_back({line.client ? line.client->fd() : -1, POLLIN, 0});
        waited.push_back({line.server->fd(), POLLIN, 0});
      }
      constexpr int kLook_ms = 2;
      if (::poll(waited.data(), waited.size(), kLook_ms) <= 0 || cut_) continue;
      std::size_t k = 1;
      for (auto line = lines_.begin(); line != lines_.end(); k += 2) {
        const bool goes_on = (waited[k].revents == 0 || carry_request(*line)) &&
                             (waited[k + 1].revents == 0 || carry_answer(*line));
        line = goes_on ? std::next(line) : lines_.erase(line);
      }
      if ((waited.front().revents & POLLIN) != 0) begin_line();
    }
  }

  void begin_line() {
    Line line{std::make_unique<Socket>(::accept(listening_.fd(), nullptr, nullptr)),
              std::make_unique<Socket>(::socket(AF_INET, SOCK_STREAM, 0))};
    const sockaddr_in server = loopback(server_port_);
    if (!dead_ &&
        ::connect(line.server->fd(), reinterpret_cast<const sockaddr*>(&server), sizeof server) == 0)
      lines_.push_back(std::move(line));
  }

  static bool send_all(const Socket& to, std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(to.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }

  bool carry_request(Line& line) {
    const ssize_t got = ::recv(line.client->fd(), bytes_.data(), bytes_.size(), 0);
    if (got <= 0) return false;
    const Mishap mishap = befalls_();
    if (mishap == Mishap::kUnheard) return false;
    if (!send_all(*line.server, {bytes_.data(), static_cast<std::size_t>(got)})) return false;
    if (mishap == Mishap::kDeath) dead_ = true;
    // The server's end stays until it has answered: it may not have read yet.
    if (mishap != Mishap::kNone) line.client.reset();
    return true;
  }
  bool carry_answer(Line& line) {
    const ssize_t got = ::recv(line.server->fd(), bytes_.data(), bytes_.size(), 0);
    return got > 0 && line.client && send_all(*line.client, {bytes_.data(), static_cast<std::size_t>(got)});
  }

  const int server_port_;
  const std::function<Mishap()> befalls_;
  const Socket listening_;
  int port_ = 0;
  std::list<Line> lines_;
  std::array<char, 1 << 16> bytes_{};
  std::atomic<bool> ended_{false}, dead_{false}, cut_{false};
  std::thread thread_;
};

class ServerWorld final : public testing::SimulatedWorld {
 public:
  explicit ServerWorld(std::string address) : address_(std::move(address)) {
    std::smatch found;
    if (!std::regex_search(address_, found, std::regex("127\\.0\\.0\\.1:([0-9]+)")))
      throw std::runtime_error("the server's address has no port");
    server_port_ = std::stoi(found[1]);
  }
  int begin_process() override {
    const std::lock_guard lock(mutex_);
    wires_.try_emplace(++last_, server_port_, [this] { return befalls(); });
    return last_;
  }
  Result<std::unique_ptr<JobStore>> open(int process, bool is_service) override {
    const std::string place = "127.0.0.1:";
    const std::string address = std::regex_replace(address_, std::regex("127\\.0\\.0\\.1:[0-9]+"),
                                                   place + std::to_string(wires_.at(process).port()));
    // Some try again what was lost, and some have no time to. A call of the dead takes all of it.
    const std::chrono::milliseconds deadline(is_service ? 3000 : process % 2 == 0 ? 500 : 40);
    return open_postgres_job_store(address, {.deadline = deadline});
  }
  void arm(int mishap, int after) override {
    constexpr int kRequests = 8;  // of a call there are a few
    const std::lock_guard lock(mutex_);
    armed_ = static_cast<Mishap>(mishap);
    requests_left_ = after % kRequests;
  }
  void rest() override {
    const std::lock_guard lock(mutex_);
    armed_ = Mishap::kNone;
  }
  bool is_dead(int process) const override { return wires_.at(process).is_dead(); }
  void die(int process) override {
    if (const auto wire = wires_.find(process); wire != wires_.end()) wire->second.die();
  }
  void lose_power() override {
    for (auto& [process, wire] : wires_) wire.cut();
  }

 private:
  // Called by the wires' threads.
  Mishap befalls() {
    const std::lock_guard lock(mutex_);
    if (armed_ == Mishap::kNone || requests_left_-- > 0) return Mishap::kNone;
    if (armed_ == Mishap::kRestart) lose_power();
    return std::exchange(armed_, Mishap::kNone);
  }

  std::string address_;
  int server_port_ = 0, last_ = 0;
  std::mutex mutex_;
  Mishap armed_ = Mishap::kNone;
  int requests_left_ = 0;
  std::map<int, Wire> wires_;  // the last: their threads use what stands before
};

// SLIPWAY_SEEDS="FIRST COUNT" runs others.
TEST(SimulatedPostgresStore, KeepsItsPromisesWhateverHappens) {
  std::uint64_t first = 0, count = 10;
  if (const char* const given = std::getenv("SLIPWAY_SEEDS")) std::istringstream(given) >> first >> count;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const auto schema = testing::PostgresSchema::make();
    if (!schema) GTEST_SKIP() << testing::kNoPostgres;
    ServerWorld world(schema->address());
    ASSERT_EQ(testing::simulate_jobs(seed, world), "");
  }
}

}  // namespace
}  // namespace slipway::api
