#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "server/http/http_answers.h"
#include "server/http/http_gatherer.h"
#include "server/http/http_listener.h"
#include "server/http/http_options.h"
#include "server/http/http_socket.h"
#include "server/http/http_workers.h"

namespace slipway::server {

// One thread that owns every socket. It accepts, gathers requests, hands whole ones to the workers, sends
// what clients did not take at once, and holds everyone to the deadlines. Since it alone ever waits for
// clients, a thousand slow ones cost memory (bounded) and no thread.
//
// A connection goes round: kReceiving, kWorking (the socket is a worker's), kSending if need be, kReceiving
// again; and in the end kSending, kLingering, closed. An answer that goes on is kStreaming between what is
// sent.
class HttpLoop {
 public:
  HttpLoop(const HttpOptions& options, const Answers& answers, LiveCounters& counters, Listener listener);

  // Empty when epoll and eventfd were to be had.
  const std::string& fault() const { return fault_; }

  // Until stop(), and then until the requests that have begun are answered or drain_deadline is over.
  void run(HttpWorkers& workers);

  // From any thread.
  void stop();
  void done(WorkDone work);

 private:
  using Clock = std::chrono::steady_clock;
  enum class Phase { kReceiving, kWorking, kSending, kStreaming, kLingering };
  enum class Timing { kNone, kFresh, kIdle, kHead, kBody, kSending, kLingering };

  struct Connection {
    Connection(std::uint64_t its_id, Accepted accepted, const HttpOptions& options)
        : id(its_id),
          socket(std::move(accepted.socket)),
          address(std::move(accepted.address)),
          gatherer(options) {}
    ~Connection() {
      if (stream) stream->shut();
    }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    std::uint64_t id;
    Socket socket;
    std::string address;
    RequestGatherer gatherer;
    Phase phase = Phase::kReceiving;
    Timing timing = Timing::kNone;
    Clock::time_point deadline = Clock::time_point::max();
    std::size_t waited_for = 0;  // of the body: bytes for which the deadline was put off
    std::size_t taken = 0;       // of the answer: bytes since the deadline was set
    bool admitted = true;      // counted in the caps; false for one that only gets to hear why it was refused
    bool readable = false;     // edge-triggered: true until recv() says that there is nothing
    bool hung_up = false;      // the peer will send no more than what is there
    bool close_after = false;  // the answer that is being sent is the last one
    std::string unsent;
    std::size_t sent = 0;                  // of unsent
    std::size_t requests = 0;              // handed to workers
    std::size_t counted = 0;               // its share of buffered_bytes
    std::size_t discarded = 0;             // while lingering
    std::shared_ptr<AnswerStream> stream;  // of an answer that goes on
    BodyPieces pieces;                     // of the answer, which follow what is unsent
  };

  void turn(HttpWorkers& workers);
  void watch_listener(bool on);
  void accept_waiting();
  void admit(Accepted accepted);
  void turn_away(Accepted accepted);
  bool watch(const Connection& connection);
  void on_event(std::uint64_t id, std::uint32_t events, HttpWorkers& workers);
  void take_back(HttpWorkers& workers);
  void open_stream(Connection& connection, const std::function<void(std::shared_ptr<AnswerStream>)>& open);
  void take_from_streams(HttpWorkers& workers);
  bool watch_streaming(Connection& connection, bool& blocked);
  void wake();
  void sweep();
  void begin_drain();

  // Each goes on with a connection as far as it can now; false: it is to be closed.
  bool proceed(Connection& connection, HttpWorkers& workers);
  bool receive(Connection& connection, bool& blocked);
  bool send_rest(Connection& connection, bool& blocked);
  bool linger(Connection& connection, bool& blocked);
  void go_on(Connection& connection, HttpWorkers& workers);
  void dispatch(Connection& connection, HttpWorkers& workers);
  void ask_for_piece(Connection& connection, HttpWorkers& workers);
  void refuse(Connection& connection, const Error& error);
  bool keep_to_budget(Connection& connection);
  void recount(Connection& connection);
  void retime(Connection& connection);
  void wait_for_what_comes(Connection& connection);
  // Whether the client takes its answer fast enough to be waited for again.
  bool is_taken(Connection& connection, Clock::time_point now) const;
  void close(Connection& connection);

  const HttpOptions& options_;
  const Answers& answers_;
  LiveCounters& counters_;
  HttpEngine engine_;  // for refusals, which need no handler
  Listener listener_;
  Socket epoll_;
  Socket wake_;
  std::string fault_;
  std::string full_;  // the answer to those over a cap, written once

  std::unordered_map<std::uint64_t, std::unique_ptr<Connection>> connections_;
  std::unordered_map<std::string, std::size_t> per_address_;
  std::size_t admitted_ = 0;
  std::size_t turned_away_ = 0;
  std::uint64_t next_id_ = 2;         // 0 is the listener, 1 the wake-up
  std::vector<std::uint64_t> again_;  // had more to read than one turn allows
  bool listening_ = false;
  bool starved_ = false;  // of descriptors, and the log says so
  bool draining_ = false;
  Clock::time_point drained_by_ = Clock::time_point::max();
  Clock::time_point next_sweep_;
  std::array<char, std::size_t{64} << 10> piece_{};
  std::size_t piece_read_ = 0;  // of piece_, by the last recv()

  std::atomic<bool> stop_asked_ = false;
  std::mutex done_mutex_;
  std::vector<WorkDone> done_;
  std::vector<std::uint64_t> fed_;  // connections whose streams have something to take
};

}  // namespace slipway::server
