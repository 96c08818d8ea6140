#include "api/jobs/job_progress.h"

#include <algorithm>
#include <utility>

#include "api/json/writer.h"

namespace slipway::api {

using std::chrono::milliseconds;

JobProgress::JobProgress(const JobProgressPlace& place, Lease lease, std::function<void()> on_writing)
    : place_(place),
      lease_(std::move(lease)),
      on_writing_(std::move(on_writing)),
      begun_(Clock::now()),
      written_(begun_),
      rings_(place.rings),
      heard_(begun_.time_since_epoch()) {}

void JobProgress::report(std::string_view stage, double fraction) {
  heard_ = Clock::now().time_since_epoch();
  const std::scoped_lock lock(mutex_);
  const bool is_news = stage != stage_ && lease_.whole.empty();
  stage_ = stage;
  fraction_ = fraction;
  if (is_news || Clock::now() - written_ >= place_.progress_interval) write();
}

bool JobProgress::cancelled() const {
  const Clock::time_point now = Clock::now();
  heard_ = now.time_since_epoch();
  if (cancelled_ || place_.stopping || is_over_time()) return true;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return cancelled_;  // somebody else is just writing
  // Work that asks but has nothing to report is alive too, and may be wanted no more.
  constexpr int kRenewalsPerLease = 3;
  const auto renewal = std::min(place_.renewal, place_.lease / kRenewalsPerLease);
  constexpr milliseconds kBetweenLooks{20};  // others' jobs ring too
  const bool rung = rings_ != place_.rings && now - written_ >= kBetweenLooks;
  if (rung || now - written_ >= renewal) write();
  return cancelled_;
}

void JobProgress::found(const RouteSoFar& route) {
  json::Writer w;
  w.begin_object().significant("cost", route.cost).metres("length_m", route.length_m);
  if (!route.verdict.empty()) w.text("verdict", route.verdict);
  w.key("line").begin_array();
  for (const auto& [x_m, y_m] : route.line_m) {
    w.begin_array().metres(x_m).metres(y_m);
    w.end_array();
  }
  w.end_array().end_object();
  const std::scoped_lock lock(mutex_);
  best_so_far_ = w.take();
  write();
}

bool JobProgress::is_over_time() const {
  return place_.max_time && Clock::now() - begun_ > *place_.max_time;
}

milliseconds JobProgress::silence() const {
  return std::chrono::duration_cast<milliseconds>(Clock::now().time_since_epoch() - heard_.load());
}

// Under mutex_.
void JobProgress::write() const {
  written_ = Clock::now();
  rings_ = place_.rings;
  on_writing_();
  const auto term = place_.store.lease_term(place_.lease);
  if (!term) return;
  const auto held =
      place_.store.report(lease_, stage_, fraction_, term->until, std::exchange(best_so_far_, {}));
  // A store that can't be read or written for a moment is no reason to throw the work away.
  if (held && !*held) cancelled_ = true;
}

}  // namespace slipway::api
