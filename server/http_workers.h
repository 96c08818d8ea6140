#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/http_answers.h"
#include "server/http_gatherer.h"
#include "server/http_options.h"

namespace slipway::server {

// A whole request, and the socket that is the worker's to send on until it gives the work back.
struct Work {
  std::uint64_t connection = 0;
  int fd = -1;
  RequestGatherer::Gathered gathered;
  std::string remote_address;
  bool close = false;
};

struct WorkDone {
  std::uint64_t connection = 0;
  std::string unsent;    // what the client did not take at once: from `sent` on
  std::size_t sent = 0;
  bool close = false;
  bool broken = false;  // the client has gone
};

// The threads in which handlers run. They never wait for a client: what a socket does not take is given back.
class HttpWorkers {
 public:
  // `answers` and `served` outlive this; `done` is called from the threads.
  HttpWorkers(const HttpOptions& options, const Answers& answers, std::atomic<std::uint64_t>& served,
              std::function<void(WorkDone)> done);
  ~HttpWorkers();
  HttpWorkers(const HttpWorkers&) = delete;
  HttpWorkers& operator=(const HttpWorkers&) = delete;

  // As many as there are connections can wait, and no more: each has one request here at a time.
  void submit(Work work);
  // Returns when the handlers that are running have; what waits is forgotten.
  void stop();

 private:
  void run();
  void answer(HttpEngine& engine, Work work);

  const HttpOptions& options_;
  const Answers& answers_;
  std::atomic<std::uint64_t>& served_;
  std::function<void(WorkDone)> done_;
  std::mutex mutex_;
  std::condition_variable condition_;
  std::deque<Work> waiting_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace slipway::server
