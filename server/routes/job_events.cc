#include "server/routes/job_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <utility>

namespace slipway::server {
namespace {

constexpr std::string_view kEventStream = "text/event-stream";

std::string event_of(const api::Job& job, const std::string& document) {
  return fmt::format("id: {}\nevent: job\ndata: {}\n\n", job.version, document);
}

// -1 where there is none, or it is none of ours.
std::int64_t last_heard(const HttpRequest& request) {
  std::int64_t version = -1;
  const std::string text = request.header("Last-Event-ID").value_or("");
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), version);
  return error == std::errc() && end == text.data() + text.size() ? version : -1;
}

}  // namespace

JobEvents::JobEvents(api::JobStore& store, std::function<std::string(const api::Job&)> status_of,
                     JobEventOptions options)
    : store_(store), status_of_(std::move(status_of)), options_(options), thread_([this] { run(); }) {}

JobEvents::~JobEvents() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
  for (Listener& listener : listeners_) listener.stream->end();
}

std::size_t JobEvents::streams() const {
  const std::lock_guard lock(mutex_);
  return listeners_.size();
}

Result<HttpResponse> JobEvents::open(const api::Job& job, const HttpRequest& request) {
  const std::int64_t heard = last_heard(request);
  HttpResponse response;
  if (heard == job.version && api::has_ended(job.state)) {
    response.status = 204;
    return response;
  }
  if (streams() >= options_.max_streams)
    return fail(ErrorCode::kNotReady, "too many event streams are open; ask for the job's status instead");
  response.content_type = kEventStream;
  response.headers.emplace_back("Cache-Control", "no-store");
  response.headers.emplace_back("X-Accel-Buffering", "no");  // a proxy is to pass each event on at once
  const auto may_hear = [this, path = request.raw_path, authorization = request.header("Authorization")] {
    return !options_.admits || options_.admits("GET", path, authorization);
  };
  response.stream = [this, id = job.id, heard, may_hear](std::shared_ptr<AnswerStream> stream) {
    {
      const std::lock_guard lock(mutex_);
      listeners_.push_back({id, heard, std::move(stream), Clock::now(), may_hear});
      has_new_ = true;
    }
    changed_.notify_all();
  };
  return response;
}

void JobEvents::run() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    changed_.wait(lock, [this] { return stopping_ || !listeners_.empty(); });
    if (stopping_) return;
    has_new_ = false;
    look(lock);
    changed_.wait_for(lock, options_.look_every, [this] { return stopping_ || has_new_; });
  }
}

void JobEvents::look(std::unique_lock<std::mutex>& lock) {
  std::map<std::string, Seen> jobs;
  for (const Listener& listener : listeners_) jobs[listener.job].heard.insert(listener.heard);
  // The store may be slow, and the thread of all sockets takes this lock.
  lock.unlock();
  for (auto& [id, seen] : jobs) {
    seen.job = store_.get(id).value_or(std::nullopt);
    const bool told = seen.job && seen.heard.size() == 1 && seen.heard.contains(seen.job->version);
    if (seen.job && !told) seen.event = event_of(*seen.job, status_of_(*seen.job));
  }
  lock.lock();
  std::erase_if(listeners_, [&](Listener& listener) {
    const auto seen = jobs.find(listener.job);
    return seen != jobs.end() && !tell(listener, seen->second);  // who came meanwhile is told next
  });
}

bool JobEvents::send(Listener& listener, std::string_view bytes) {
  if (listener.may_hear()) return listener.stream->send(bytes);
  listener.stream->end();
  return false;
}

bool JobEvents::tell(Listener& listener, const Seen& seen) {
  const Clock::time_point now = Clock::now();
  if (!seen.job) {  // it is not kept any more
    listener.stream->end();
    return false;
  }
  if (seen.job->version != listener.heard) {
    if (seen.event.empty()) return true;  // this one came meanwhile
    if (!send(listener, seen.event)) return false;
    listener.heard = seen.job->version;
    listener.last_sent = now;
  } else if (now - listener.last_sent >= options_.heartbeat_every) {
    if (!send(listener, ":\n\n")) return false;
    listener.last_sent = now;
  }
  if (!api::has_ended(seen.job->state)) return true;
  listener.stream->end();
  return false;
}

}  // namespace slipway::server
