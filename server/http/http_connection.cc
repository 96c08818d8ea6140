// What becomes of one connection in the loop; http_loop.cc has what concerns all of them.

#include <sys/socket.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "server/http/http_loop.h"

namespace slipway::server {
namespace {

// Read from one connection before the others have their turn.
constexpr std::size_t kReadPerTurn = std::size_t{256} << 10;

}  // namespace

void HttpLoop::go_on(Connection& connection, HttpWorkers& workers) {
  if (!proceed(connection, workers)) return close(connection);
  if (connection.phase != Phase::kWorking) recount(connection);
  retime(connection);
}

bool HttpLoop::proceed(Connection& connection, HttpWorkers& workers) {
  std::size_t read = 0;
  for (bool blocked = false; !blocked;) {
    switch (connection.phase) {
      case Phase::kWorking:
        return true;
      case Phase::kSending:
        if (connection.pieces && connection.unsent.empty())
          ask_for_piece(connection, workers);
        else if (!send_rest(connection, blocked))
          return false;
        break;
      case Phase::kStreaming:
        if (!watch_streaming(connection, blocked)) return false;
        break;
      case Phase::kLingering:
        if (!linger(connection, blocked)) return false;
        break;
      case Phase::kReceiving: {
        const RequestGatherer::State state = connection.gatherer.feed({});
        if (state == RequestGatherer::State::kReady) {
          dispatch(connection, workers);
        } else if (state == RequestGatherer::State::kRefused) {
          refuse(connection, connection.gatherer.refusal());
        } else if (!receive(connection, blocked)) {
          return false;
        }
        if (!keep_to_budget(connection)) return false;
        break;
      }
    }
    read += piece_read_;
    piece_read_ = 0;
    if (read >= kReadPerTurn && !blocked) {
      again_.push_back(connection.id);
      return true;
    }
  }
  return true;
}

bool HttpLoop::receive(Connection& connection, bool& blocked) {
  if (connection.gatherer.take_continue()) {
    // 25 bytes into a socket on which nothing is under way; a client that does not take them is not worth
    // waiting for.
    std::string_view interim = "HTTP/1.1 100 Continue\r\n\r\n";
    if (send_some(connection.socket.fd(), interim) != Transfer::kSome) return false;
  }
  if (!connection.readable) {
    blocked = true;
    return true;
  }
  const std::size_t wanted = std::min(connection.gatherer.appetite(), piece_.size());
  const Transfer received = receive_some(connection.socket.fd(), piece_.data(), wanted, piece_read_);
  if (received == Transfer::kSome) {
    // Less than asked for means that nothing is left, and saves the call that would say so; but the end of
    // the stream may have been announced with these bytes and is not announced again.
    if (piece_read_ < wanted && !connection.hung_up) connection.readable = false;
    connection.gatherer.feed({piece_.data(), piece_read_});
    return true;
  }
  connection.readable = false;
  blocked = true;
  return received == Transfer::kBlocked;
}

void HttpLoop::dispatch(Connection& connection, HttpWorkers& workers) {
  recount(connection);  // and so it stays counted while it is with a worker
  Work work;
  work.connection = connection.id;
  work.fd = connection.socket.fd();
  work.gathered = connection.gatherer.take();
  work.remote_address = connection.address;
  ++connection.requests;
  work.close = draining_ || !work.gathered.head.keep_alive ||
               connection.requests >= options_.max_requests_per_connection;
  connection.phase = Phase::kWorking;
  workers.submit(std::move(work));
}

void HttpLoop::ask_for_piece(Connection& connection, HttpWorkers& workers) {
  recount(connection);
  Work work;
  work.connection = connection.id;
  work.fd = connection.socket.fd();
  work.remote_address = connection.address;
  work.close = connection.close_after;
  work.pieces = std::exchange(connection.pieces, {});
  connection.phase = Phase::kWorking;
  workers.submit(std::move(work));
}

void HttpLoop::refuse(Connection& connection, const Error& error) {
  counters_.requests_refused.fetch_add(1, std::memory_order_relaxed);
  connection.unsent =
      answers_.to_refused(engine_, {connection.gatherer.head().method, connection.gatherer.origin()}, error);
  connection.gatherer.refuse(error);  // and what it holds is free for others
  connection.sent = 0;
  connection.phase = Phase::kSending;
  // What follows on this connection is the rest of something that was not understood.
  connection.close_after = true;
}

bool HttpLoop::send_rest(Connection& connection, bool& blocked) {
  std::string_view rest = std::string_view(connection.unsent).substr(connection.sent);
  const Transfer sent = send_some(connection.socket.fd(), rest);
  if (sent == Transfer::kBroken) return false;
  const std::size_t before = std::exchange(connection.sent, connection.unsent.size() - rest.size());
  connection.taken += connection.sent - before;
  if (sent == Transfer::kBlocked) {
    blocked = true;
    return keep_to_budget(connection);
  }
  connection.unsent = {};
  connection.sent = 0;
  if (connection.pieces) return true;
  if (!connection.close_after) {
    connection.phase = connection.stream ? Phase::kStreaming : Phase::kReceiving;
    return true;
  }
  connection.phase = Phase::kLingering;
  return ::shutdown(connection.socket.fd(), SHUT_WR) == 0;
}

// What a client says while it listens is nothing to us, but its end is.
bool HttpLoop::watch_streaming(Connection& connection, bool& blocked) {
  if (connection.hung_up) return false;
  blocked = !connection.readable;
  if (blocked) return true;
  const Transfer received = receive_some(connection.socket.fd(), piece_.data(), piece_.size(), piece_read_);
  if (received == Transfer::kSome) return true;
  connection.readable = false;
  blocked = true;
  return received == Transfer::kBlocked;
}

bool HttpLoop::linger(Connection& connection, bool& blocked) {
  blocked = !connection.readable;
  if (blocked) return true;
  const Transfer received = receive_some(connection.socket.fd(), piece_.data(), piece_.size(), piece_read_);
  if (received == Transfer::kSome) {
    connection.discarded += piece_read_;
    return connection.discarded <= options_.max_body_bytes;
  }
  connection.readable = false;
  blocked = true;
  return received == Transfer::kBlocked;
}

bool HttpLoop::keep_to_budget(Connection& connection) {
  if (connection.phase == Phase::kWorking) return true;
  recount(connection);
  if (counters_.buffered_bytes <= options_.max_buffered_bytes || connection.counted <= kAlwaysBuffered)
    return true;
  if (connection.phase == Phase::kReceiving) {
    refuse(connection,
           {ErrorCode::kTooManyJobs, "too many large requests are under way; try again later", {}});
    return true;
  }
  return true;  // an answer being sent had its share from the worker, or is a refusal and small
}

void HttpLoop::recount(Connection& connection) {
  // An answer in pieces has its share for the next one already.
  const std::size_t piece = connection.pieces ? kMaxPieceBytes : 0;
  const std::size_t now = connection.gatherer.held() + std::max(connection.unsent.size(), piece);
  counters_.buffered_bytes += now - connection.counted;  // modulo 2^64, so that it may shrink
  connection.counted = now;
}

void HttpLoop::wait_for_what_comes(Connection& connection) {
  const std::size_t received = connection.gatherer.received();
  if (received <= connection.waited_for) return;
  connection.deadline += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(
      static_cast<double>(received - connection.waited_for) / static_cast<double>(options_.min_bytes_per_s)));
  connection.waited_for = received;
}

void HttpLoop::retime(Connection& connection) {
  using State = RequestGatherer::State;
  Timing timing = Timing::kNone;
  if (connection.phase == Phase::kSending) timing = Timing::kSending;
  if (connection.phase == Phase::kLingering) timing = Timing::kLingering;
  if (connection.phase == Phase::kReceiving) {
    const State state = connection.gatherer.state();
    timing = state == State::kHead      ? Timing::kHead
             : state == State::kBody    ? Timing::kBody
             : connection.requests == 0 ? Timing::kFresh
                                        : Timing::kIdle;
  }
  // A deadline runs from the beginning of what it is for, so that dripping bytes do not extend it.
  if (timing == connection.timing) {
    if (timing == Timing::kBody) wait_for_what_comes(connection);
    return;
  }
  connection.waited_for = 0;
  connection.taken = 0;
  connection.timing = timing;
  const auto allowed = [&]() -> std::chrono::milliseconds {
    switch (timing) {
      case Timing::kFresh:
      case Timing::kHead:
        return options_.header_deadline;
      case Timing::kIdle:
        return options_.idle_deadline;
      case Timing::kBody:
        return options_.body_deadline;
      case Timing::kSending:
        return options_.write_deadline;
      case Timing::kLingering:
        return options_.linger_deadline;
      case Timing::kNone:
        break;
    }
    return std::chrono::milliseconds::zero();
  }();
  connection.deadline = timing == Timing::kNone ? Clock::time_point::max() : Clock::now() + allowed;
}

bool HttpLoop::is_taken(Connection& connection, Clock::time_point now) const {
  const std::chrono::duration<double> window = options_.write_deadline;
  const double enough = static_cast<double>(options_.min_bytes_per_s) * window.count();
  if (connection.timing != Timing::kSending || static_cast<double>(connection.taken) < enough) return false;
  connection.taken = 0;
  connection.deadline = now + options_.write_deadline;
  return true;
}

void HttpLoop::close(Connection& connection) {
  counters_.buffered_bytes -= connection.counted;
  if (connection.admitted) {
    --admitted_;
    const auto of_address = per_address_.find(connection.address);
    if (--of_address->second == 0) per_address_.erase(of_address);
    counters_.open_connections.store(admitted_, std::memory_order_relaxed);
  } else {
    --turned_away_;
  }
  connections_.erase(connection.id);
}

}  // namespace slipway::server
