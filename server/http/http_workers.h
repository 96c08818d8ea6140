#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/http/http_answers.h"
#include "server/http/http_fair_queue.h"
#include "server/http/http_gatherer.h"
#include "server/http/http_options.h"

namespace slipway::server {

// Bodies and answers up to this size pass even when max_buffered_bytes is exhausted: a flood of large ones
// must not shut out the small requests of everyone else.
inline constexpr std::size_t kAlwaysBuffered = std::size_t{16} << 10;

// The live form of HttpCounters, and the budget of which several threads take.
struct LiveCounters {
  std::atomic<std::uint64_t> open_connections = 0;
  std::atomic<std::uint64_t> requests_served = 0;
  std::atomic<std::uint64_t> requests_refused = 0;
  std::atomic<std::uint64_t> requests_abandoned = 0;
  std::atomic<std::uint64_t> connections_refused = 0;
  std::atomic<std::size_t> buffered_bytes = 0;
};

// A whole request, or an answer to go on with, and the socket that is the worker's to send on until it gives
// the work back.
struct Work {
  std::uint64_t connection = 0;
  int fd = -1;
  RequestGatherer::Gathered gathered;
  std::string remote_address;
  bool close = false;
  BodyPieces pieces = {};  // of the answer to go on with; empty: there is a request
  std::chrono::steady_clock::time_point submitted = {};
};

struct WorkDone {
  std::uint64_t connection = 0;
  std::string unsent;  // what the client did not take at once: from `sent` on
  std::size_t sent = 0;
  std::size_t counted = 0;  // of the answer, or of its next piece, in the budget of buffered bytes already
  bool close = false;
  bool broken = false;  // the client has gone
  std::function<void(std::shared_ptr<AnswerStream>)> stream = {};
  BodyPieces pieces = {};  // which are to follow
};

// The threads in which handlers run, see Threads. They never wait for a client: what a socket does not take
// is given back.
class HttpWorkers {
 public:
  // `answers` and `counters` outlive this; `done` is called from the threads.
  HttpWorkers(const HttpOptions& options, const Answers& answers, LiveCounters& counters,
              std::function<void(WorkDone)> done);
  ~HttpWorkers();
  HttpWorkers(const HttpWorkers&) = delete;
  HttpWorkers& operator=(const HttpWorkers&) = delete;

  // As many as there are connections can wait, and no more: each has one request here at a time.
  void submit(Work work);
  // Returns when the handlers that are running have; what waits is forgotten.
  void stop();

 private:
  // Work that waits for threads of one sort.
  struct Queue {
    std::condition_variable condition;
    FairQueue<Work> waiting;
  };

  Threads threads_of(const Work& work) const;
  std::string whose(const Work& work) const;
  void run(Queue& queue);
  void answer(HttpEngine& engine, Work work);
  void go_on(Work work);
  bool has_room(std::size_t bytes);

  const HttpOptions& options_;
  const Answers& answers_;
  LiveCounters& counters_;
  std::function<void(WorkDone)> done_;
  std::mutex mutex_;
  std::map<Threads, Queue> queues_;  // all there from the beginning
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace slipway::server
