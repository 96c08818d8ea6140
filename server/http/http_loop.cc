#include "server/http/http_loop.h"

#include <fmt/format.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace slipway::server {
namespace {

constexpr std::uint64_t kListenerId = 0;
constexpr std::uint64_t kWakeId = 1;
// Deadlines are looked at so often; none is shorter by much.
constexpr std::chrono::milliseconds kSweepEvery{25};
// Connections accepted in one turn, so that a flood of them does not keep the others waiting.
constexpr int kAcceptedPerTurn = 64;
// Of the connections over a cap, so many at once get an answer that says why; the rest are just closed.
constexpr std::size_t kTurnedAwayAtOnce = 32;

}  // namespace

HttpLoop::HttpLoop(const HttpOptions& options, const Answers& answers, LiveCounters& counters,
                   Listener listener)
    : options_(options),
      answers_(answers),
      counters_(counters),
      engine_(options),
      listener_(std::move(listener)),
      epoll_(epoll_create1(EPOLL_CLOEXEC)),
      wake_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)),
      next_sweep_(Clock::now()) {
  full_ = answers_.to_refused(
      engine_, {"GET", std::nullopt},
      {ErrorCode::kTooManyJobs, "there are too many connections; try again when some have ended", {}});
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.u64 = kWakeId;
  if (!epoll_.is_open() || !wake_.is_open() ||
      epoll_ctl(epoll_.fd(), EPOLL_CTL_ADD, wake_.fd(), &event) != 0) {
    fault_ = "no descriptors are left for epoll and eventfd";
  }
}

void HttpLoop::run(HttpWorkers& workers) {
  watch_listener(true);
  while (!draining_ || (!connections_.empty() && Clock::now() < drained_by_)) turn(workers);
}

void HttpLoop::stop() {
  stop_asked_ = true;
  eventfd_write(wake_.fd(), 1);
}

void HttpLoop::done(WorkDone work) {
  bool first = false;
  {
    const std::lock_guard lock(done_mutex_);
    first = done_.empty();
    done_.push_back(std::move(work));
  }
  if (first) wake();
}

void HttpLoop::wake() {
  eventfd_write(wake_.fd(), 1);
}

void HttpLoop::turn(HttpWorkers& workers) {
  const bool timed = !connections_.empty() || !listening_;
  const int wait_ms = !again_.empty() ? 0 : timed ? static_cast<int>(kSweepEvery.count()) : -1;
  std::array<epoll_event, 256> events{};
  const int count = epoll_wait(epoll_.fd(), events.data(), static_cast<int>(events.size()), wait_ms);
  for (int i = 0; i < count; ++i) {
    const epoll_event& event = events[static_cast<std::size_t>(i)];
    if (event.data.u64 == kListenerId) {
      accept_waiting();
    } else if (event.data.u64 == kWakeId) {
      eventfd_t ignored = 0;
      eventfd_read(wake_.fd(), &ignored);
    } else {
      on_event(event.data.u64, event.events, workers);
    }
  }
  take_back(workers);
  take_from_streams(workers);
  for (const std::uint64_t id : std::exchange(again_, {})) on_event(id, 0, workers);
  if (stop_asked_ && !draining_) begin_drain();
  if (Clock::now() >= next_sweep_) sweep();
}

void HttpLoop::watch_listener(bool on) {
  if (on == listening_ || !listener_.socket.is_open()) return;
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.u64 = kListenerId;
  const int outcome =
      epoll_ctl(epoll_.fd(), on ? EPOLL_CTL_ADD : EPOLL_CTL_DEL, listener_.socket.fd(), &event);
  if (outcome == 0) listening_ = on;
}

void HttpLoop::accept_waiting() {
  for (int i = 0; i < kAcceptedPerTurn && listening_; ++i) {
    Accepted accepted;
    const AcceptOutcome outcome = accept_one(listener_.socket, accepted);
    if (outcome == AcceptOutcome::kNobodyWaits) return;
    if (outcome == AcceptOutcome::kNoDescriptors) {
      // The connection stays in the backlog, and epoll would report it without end: look again at the next
      // sweep.
      if (!std::exchange(starved_, true)) answers_.log("no descriptors are left to accept connections with");
      return watch_listener(false);
    }
    starved_ = false;
    const auto known = per_address_.find(accepted.address);
    const std::size_t of_address = known == per_address_.end() ? 0 : known->second;
    if (admitted_ < options_.max_connections && of_address < options_.max_connections_per_address) {
      admit(std::move(accepted));
    } else {
      turn_away(std::move(accepted));
    }
  }
}

void HttpLoop::admit(Accepted accepted) {
  const std::uint64_t id = next_id_++;
  auto connection = std::make_unique<Connection>(id, std::move(accepted), options_);
  if (!watch(*connection)) return;
  ++admitted_;
  ++per_address_[connection->address];
  counters_.open_connections.store(admitted_, std::memory_order_relaxed);
  retime(*connection);
  connections_.emplace(id, std::move(connection));
}

void HttpLoop::turn_away(Accepted accepted) {
  counters_.connections_refused.fetch_add(1, std::memory_order_relaxed);
  if (turned_away_ >= kTurnedAwayAtOnce) return;
  const std::uint64_t id = next_id_++;
  auto connection = std::make_unique<Connection>(id, std::move(accepted), options_);
  connection->admitted = false;
  connection->phase = Phase::kSending;
  connection->close_after = true;
  connection->unsent = full_;
  if (!watch(*connection)) return;
  ++turned_away_;
  retime(*connection);
  // A fresh socket is writable, and epoll says so in the next turn.
  connections_.emplace(id, std::move(connection));
}

bool HttpLoop::watch(const Connection& connection) {
  epoll_event event{};
  // Edge-triggered, so that a request on a kept connection costs no call of epoll_ctl().
  event.events = EPOLLIN | EPOLLOUT | EPOLLRDHUP | EPOLLET;
  event.data.u64 = connection.id;
  return epoll_ctl(epoll_.fd(), EPOLL_CTL_ADD, connection.socket.fd(), &event) == 0;
}

void HttpLoop::on_event(std::uint64_t id, std::uint32_t events, HttpWorkers& workers) {
  const auto found = connections_.find(id);
  if (found == connections_.end()) return;
  Connection& connection = *found->second;
  constexpr std::uint32_t kHangUp = EPOLLRDHUP | EPOLLHUP | EPOLLERR;
  if ((events & kHangUp) != 0) connection.hung_up = true;
  if ((events & (EPOLLIN | kHangUp)) != 0) connection.readable = true;
  go_on(connection, workers);
}

void HttpLoop::take_back(HttpWorkers& workers) {
  std::vector<WorkDone> returned;
  {
    const std::lock_guard lock(done_mutex_);
    returned.swap(done_);
  }
  for (WorkDone& work : returned) {
    Connection& connection = *connections_.at(work.connection);
    connection.close_after = work.close || draining_;
    connection.phase = Phase::kSending;
    connection.unsent = std::move(work.unsent);
    connection.sent = work.sent;
    connection.counted += work.counted;
    connection.pieces = std::move(work.pieces);
    if (work.broken) {
      close(connection);
      continue;
    }
    if (work.stream) open_stream(connection, work.stream);
    go_on(connection, workers);
  }
}

void HttpLoop::open_stream(Connection& connection,
                           const std::function<void(std::shared_ptr<AnswerStream>)>& open) {
  connection.stream = std::make_shared<AnswerStream>([this, id = connection.id] {
    const std::lock_guard lock(done_mutex_);
    fed_.push_back(id);
    wake();
  });
  connection.close_after = draining_;
  open(connection.stream);
}

void HttpLoop::take_from_streams(HttpWorkers& workers) {
  // A client that reads so little is let go: it will come again, and hear what is then.
  constexpr std::size_t kMaxBehind = std::size_t{256} << 10;
  std::vector<std::uint64_t> fed;
  {
    const std::lock_guard lock(done_mutex_);
    fed.swap(fed_);
  }
  for (const std::uint64_t id : fed) {
    const auto found = connections_.find(id);
    if (found == connections_.end() || !found->second->stream) continue;
    Connection& connection = *found->second;
    AnswerStream::Taken taken = connection.stream->take();
    connection.unsent.erase(0, std::exchange(connection.sent, 0));
    connection.unsent += taken.bytes;
    if (connection.unsent.size() > kMaxBehind) {
      close(connection);
      continue;
    }
    connection.close_after = connection.close_after || taken.ended;
    if (connection.phase == Phase::kStreaming) connection.phase = Phase::kSending;
    go_on(connection, workers);
  }
}

void HttpLoop::sweep() {
  const Clock::time_point now = Clock::now();
  next_sweep_ = now + kSweepEvery;
  if (!draining_) watch_listener(true);
  std::vector<Connection*> late;
  for (const auto& [id, connection] : connections_) {
    if (connection->deadline <= now && !is_taken(*connection, now)) late.push_back(connection.get());
  }
  for (Connection* connection : late) {
    const bool begun = connection->timing == Timing::kHead || connection->timing == Timing::kBody;
    if (!begun) {
      close(*connection);
      continue;
    }
    const bool head = connection->timing == Timing::kHead;
    refuse(*connection, {ErrorCode::kRequestTimeout,
                         fmt::format("the request's {} was not there within {} ms", head ? "head" : "body",
                                     (head ? options_.header_deadline : options_.body_deadline).count()),
                         {}});
    bool blocked = false;
    if (!send_rest(*connection, blocked)) {
      close(*connection);
    } else {
      retime(*connection);
    }
  }
}

void HttpLoop::begin_drain() {
  draining_ = true;
  drained_by_ = Clock::now() + options_.drain_deadline;
  watch_listener(false);
  listener_.socket.close();
  std::vector<Connection*> idle;
  for (const auto& [id, connection] : connections_) {
    const bool nothing_begun = connection->phase == Phase::kReceiving &&
                               connection->gatherer.state() == RequestGatherer::State::kIdle &&
                               !connection->readable;
    if (nothing_begun || connection->phase == Phase::kLingering || connection->phase == Phase::kStreaming)
      idle.push_back(connection.get());
  }
  for (Connection* connection : idle) close(*connection);
}

}  // namespace slipway::server
