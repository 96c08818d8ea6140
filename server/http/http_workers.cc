#include "server/http/http_workers.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "server/http/http_socket.h"

namespace slipway::server {
namespace {

// Nobody waits for the answer any more. A client that only sends no more and one that has left look the same:
// one that has not waited for long is believed to listen. What changes something is done for both.
bool is_abandoned(const Work& work) {
  constexpr std::chrono::seconds kLong{1};
  return !work.pieces && only_reads(work.gathered.head.method) &&
         std::chrono::steady_clock::now() - work.submitted > kLong && has_hung_up(work.fd);
}

}  // namespace

HttpWorkers::HttpWorkers(const HttpOptions& options, const Answers& answers, LiveCounters& counters,
                         std::function<void(WorkDone)> done)
    : options_(options), answers_(answers), counters_(counters), done_(std::move(done)) {
  const std::pair<Threads, std::size_t> sorts[] = {{Threads::kLight, options.worker_threads},
                                                   {Threads::kHeavy, options.heavy_threads},
                                                   {Threads::kPicture, options.heavy_threads},
                                                   {Threads::kShadow, 1},
                                                   {Threads::kDrawn, 1},
                                                   {Threads::kAsking, options.asking_threads},
                                                   {Threads::kPrompt, 1}};
  for (const auto& sort : sorts) queues_[sort.first];
  for (const auto& [sort, count] : sorts)
    for (std::size_t i = 0; i < std::max<std::size_t>(1, count); ++i)
      threads_.emplace_back([this, &queue = queues_.at(sort)] { run(queue); });
}

HttpWorkers::~HttpWorkers() {
  stop();
}

void HttpWorkers::submit(Work work) {
  Queue& queue = queues_.at(threads_of(work));
  const std::string turn_of = whose(work);
  work.submitted = std::chrono::steady_clock::now();
  {
    const std::lock_guard lock(mutex_);
    queue.waiting.push(turn_of, std::move(work));
  }
  queue.condition.notify_one();
}

Threads HttpWorkers::threads_of(const Work& work) const {
  if (work.pieces) return Threads::kHeavy;
  const Route* const route = answers_.route_of(work.gathered.head);
  return route == nullptr ? Threads::kLight : route->threads;
}

std::string HttpWorkers::whose(const Work& work) const {
  const RequestHead& head = work.gathered.head;
  std::string name;
  if (options_.name_of && !work.pieces)
    name = options_.name_of(head.method, head.path, header_in(head.forwarded, "Authorization"));
  return name.empty() ? work.remote_address : name;
}

void HttpWorkers::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  for (auto& [sort, queue] : queues_) queue.condition.notify_all();
  for (std::thread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
}

void HttpWorkers::run(Queue& queue) {
  HttpEngine engine(options_);
  for (;;) {
    Work work;
    {
      std::unique_lock lock(mutex_);
      queue.condition.wait(lock, [&] { return stopping_ || !queue.waiting.empty(); });
      if (stopping_) return;
      work = queue.waiting.pop();
    }
    if (is_abandoned(work)) {
      counters_.requests_abandoned.fetch_add(1, std::memory_order_relaxed);
      done_({.connection = work.connection, .unsent = {}, .broken = true});
    } else if (work.pieces)
      go_on(std::move(work));
    else
      answer(engine, std::move(work));
  }
}

void HttpWorkers::go_on(Work work) {
  WorkDone done{.connection = work.connection, .unsent = {}, .close = work.close};
  try {
    auto piece = work.pieces();
    done.broken = !piece;
    if (!piece) {
      answers_.log("an answer was broken off: " + piece.error().detail);
    } else if (*piece) {
      std::string_view rest = **piece;
      const Transfer outcome = send_some(work.fd, rest);
      const std::size_t sent = (*piece)->size() - rest.size();
      if (outcome == Transfer::kBlocked) {
        done.unsent = **std::move(piece);
        done.sent = sent;
      }
      done.broken = done.broken || outcome == Transfer::kBroken;
      done.pieces = std::move(work.pieces);
    }
  } catch (const std::exception& thrown) {
    answers_.log(std::string("an answer was broken off: ") + thrown.what());
    done.broken = true;
  }
  done_(std::move(done));
}

void HttpWorkers::answer(HttpEngine& engine, Work work) {
  WorkDone done{.connection = work.connection, .unsent = {}, .close = work.close};
  HttpEngine::Outgoing out =
      answers_.to_request(engine, {work.gathered.head.forwarded, std::move(work.gathered.body),
                                   std::move(work.gathered.body_file), work.remote_address, work.close});
  counters_.requests_served.fetch_add(1, std::memory_order_relaxed);
  // Taken here and not in the loop, which may be many answers behind; before the head, which can't be taken
  // back.
  const std::size_t share = out.body.size() + (out.pieces ? kMaxPieceBytes : 0);
  if (has_room(share)) {
    done.counted = share;
  } else {
    out = answers_.instead(
        engine, work.gathered.head.forwarded,
        {ErrorCode::kTooManyJobs, "too many large answers wait for slow clients: ask again later", {}});
    done.close = true;
  }
  // Sent from here rather than from the loop: one hop less before the client has its answer.
  std::string_view front = out.front;
  Transfer outcome = send_some(work.fd, front, !out.body.empty());
  if (outcome == Transfer::kSome) {
    std::string_view body = out.body;
    outcome = send_some(work.fd, body);
    if (outcome == Transfer::kBlocked) {
      done.sent = out.body.size() - body.size();
      done.unsent = std::move(out.body);
    }
  } else if (outcome == Transfer::kBlocked) {
    done.unsent = std::string(front) + out.body;
  }
  done.broken = done.broken || outcome == Transfer::kBroken;
  done.stream = std::move(out.stream);
  done.pieces = std::move(out.pieces);
  out = {};  // before the loop hears of it and there is more work
  done_(std::move(done));
}

bool HttpWorkers::has_room(std::size_t bytes) {
  if (counters_.buffered_bytes.fetch_add(bytes) + bytes <= options_.max_buffered_bytes ||
      bytes <= kAlwaysBuffered)
    return true;
  counters_.buffered_bytes -= bytes;
  return false;
}

}  // namespace slipway::server
