#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "api/jobs/job_store.h"
#include "server/http/http_message.h"
#include "server/http/http_stream.h"

namespace slipway::server {

struct JobEventOptions {
  std::size_t max_streams = 1000;
  std::chrono::milliseconds look_every{250};          // at the jobs that somebody listens to
  std::chrono::milliseconds heartbeat_every{15'000};  // a comment, which finds clients that have vanished
  // Whether who sent such a request may still hear the answer; where not, the stream ends before what it
  // would be told next. Empty: everybody may.
  std::function<bool(std::string_view method, std::string_view path,
                     const std::optional<std::string>& authorization)>
      admits = {};
};

// Server-sent events [the HTML standard, 9.2] of jobs: the status of a job at once and whenever it has
// changed, until the job has ended. An event's id is the version of the job, so that who connects again with
// Last-Event-ID hears only what is new. One thread looks for all streams, and sleeps where there is none.
class JobEvents {
 public:
  // `status_of` writes a job's document on one line. The store must outlive this.
  JobEvents(api::JobStore& store, std::function<std::string(const api::Job&)> status_of,
            JobEventOptions options = {});
  ~JobEvents();
  JobEvents(const JobEvents&) = delete;
  JobEvents& operator=(const JobEvents&) = delete;

  // The stream of this job; 204, which tells a client to stay away, where the last event has been heard.
  // Errors: not_ready where there are too many streams.
  Result<HttpResponse> open(const api::Job& job, const HttpRequest& request);
  std::size_t streams() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Listener {
    std::string job;
    std::int64_t heard = -1;  // version of the last event
    std::shared_ptr<AnswerStream> stream;
    Clock::time_point last_sent;
    std::function<bool()> may_hear;
  };

  void run();
  // A job that somebody listens to, as it is now.
  struct Seen {
    std::set<std::int64_t> heard;  // versions that its listeners know
    std::optional<api::Job> job;   // nothing: it is not kept any more
    std::string event;             // empty where nobody has to be told
  };
  // False: the listener is to be forgotten.
  bool tell(Listener& listener, const Seen& seen);
  static bool send(Listener& listener, std::string_view bytes);
  void look(std::unique_lock<std::mutex>& lock);

  api::JobStore& store_;
  std::function<std::string(const api::Job&)> status_of_;
  JobEventOptions options_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Listener> listeners_;
  bool stopping_ = false;
  bool has_new_ = false;  // a listener that has heard nothing yet
  std::thread thread_;
};

}  // namespace slipway::server
