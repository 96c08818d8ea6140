#include "api/jobs/postgres_bell.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

namespace slipway::api {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::array<const char*, 2> kChannels{"slipway_accepted", "slipway_ended"};
constexpr milliseconds kBetweenBells{5};
constexpr milliseconds kBeforeReconnection{500};
constexpr seconds kAnswer{5};

}  // namespace

PostgresBell::~PostgresBell() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
    wake();
  }
  stopped_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void PostgresBell::ring(StoreNews news) {
  const std::scoped_lock lock(mutex_);
  to_ring_.at(static_cast<std::size_t>(news)) = true;
  wake();
}

void PostgresBell::listen(StoreNews news, std::function<void()> call) {
  const std::scoped_lock calling(calling_);
  const std::scoped_lock lock(mutex_);
  calls_.at(static_cast<std::size_t>(news)) = std::move(call);
  wake();
}

// Under mutex_. The thread begins with the first news.
void PostgresBell::wake() {
  if (!wake_.is_open()) {
    wake_ = FileDescriptor(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC));
    if (!stopping_) thread_ = std::thread([this] { run(); });
  }
  const std::uint64_t one = 1;
  static_cast<void>(::write(wake_.fd(), &one, sizeof one));
}

void PostgresBell::run() {
  for (;;) {
    try {
      PostgresConnection connection(address_, CommitKind::kQuick);
      std::array<bool, kKinds> listening{};
      while (serve(connection, listening)) {
      }
      return;
    } catch (const PostgresFailure&) {
      std::unique_lock lock(mutex_);
      if (stopped_.wait_for(lock, kBeforeReconnection, [this] { return stopping_; })) return;
    }
  }
}

// False: enough.
bool PostgresBell::serve(PostgresConnection& connection, std::array<bool, kKinds>& listening) {
  std::array<bool, kKinds> to_ring{}, wanted{};
  {
    const std::scoped_lock lock(mutex_);
    if (stopping_) return false;
    to_ring = std::exchange(to_ring_, {});
    for (std::size_t kind = 0; kind < kKinds; ++kind) wanted.at(kind) = calls_.at(kind) != nullptr;
  }
  connection.set_deadline(PostgresConnection::Clock::now() + kAnswer);
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    if (wanted.at(kind) && !std::exchange(listening.at(kind), true)) {
      connection.run(fmt::format("LISTEN {}", kChannels.at(kind)));
      call(kind);  // something may have come before
    }
    if (to_ring.at(kind)) connection.run(fmt::format("NOTIFY {}", kChannels.at(kind)));
  }
  for (const std::string& channel : connection.notifications())
    for (std::size_t kind = 0; kind < kKinds; ++kind)
      if (channel == kChannels.at(kind)) call(kind);
  constexpr int kLook_ms = 10'000;
  std::array<pollfd, 2> polled{{{wake_.fd(), POLLIN, 0}, {connection.socket(), POLLIN, 0}}};
  ::poll(polled.data(), polled.size(), kLook_ms);
  if (polled[0].revents != 0) {
    std::this_thread::sleep_for(kBetweenBells);  // what comes meanwhile is told of with this one
    std::uint64_t count = 0;
    static_cast<void>(::read(wake_.fd(), &count, sizeof count));
  }
  return true;
}

void PostgresBell::call(std::size_t kind) {
  const std::scoped_lock calling(calling_);
  std::function<void()> call;
  {
    const std::scoped_lock lock(mutex_);
    call = calls_.at(kind);
  }
  if (call) call();
}

}  // namespace slipway::api
