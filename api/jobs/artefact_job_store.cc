#include "api/jobs/artefact_job_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <limits>
#include <utility>

#include "api/jobs/artefact_row.h"

namespace slipway::api {
namespace {

constexpr std::int64_t kHour_ms = 3'600'000, kDay_ms = 24 * kHour_ms;

class ArtefactJobStore final : public JobStore {
 public:
  ArtefactJobStore(std::unique_ptr<JobStore> store, std::shared_ptr<ArtefactFolder> folder)
      : store_(std::move(store)), folder_(std::move(folder)) {}

  Result<Job> append(const NewJob& job, std::int64_t now, const Admission& admission) override {
    return store_->append(job, now, admission);
  }
  Result<std::int64_t> lease_clock() override { return store_->lease_clock(); }
  Result<std::vector<ClaimedJob>> claim_some(std::string_view worker, const std::vector<std::string>& kinds,
                                             std::int64_t now, LeaseTerm term, int most) override {
    return store_->claim_some(worker, kinds, now, term, most);
  }
  Result<int> give_back(const std::vector<Lease>& leases) override { return store_->give_back(leases); }
  Result<bool> report(const Lease& lease, std::string_view stage, double progress, std::int64_t lease_until,
                      std::string_view best_so_far) override {
    return store_->report(lease, stage, progress, lease_until, best_so_far);
  }

  Result<std::vector<bool>> finish_all(const std::vector<JobEnd>& ends, std::int64_t now) override {
    if (folder_ == nullptr) return store_->finish_all(ends, now);
    std::vector<JobEnd> named = ends;
    for (JobEnd& end : named)
      for (std::string& page : end.outcome.series) {
        if (page.size() < kMinArtefactBytes && !page.starts_with(kArtefactMark)) continue;
        const auto name = folder_->put(page);
        if (!name) return fail(name.error());
        page = fmt::format("{}{}{:016}", kArtefactMark, *name, page.size());
      }
    return store_->finish_all(named, now);
  }

  Result<std::optional<SeriesPage>> series(std::string_view id, std::int64_t page) override {
    auto kept = store_->series(id, page);
    if (!kept || !*kept || !(*kept)->bytes.starts_with(kArtefactMark)) return kept;
    if (folder_ == nullptr)
      return fail(ErrorCode::kStorage, "the page is in a folder of artefacts: name it with --artefacts");
    auto bytes = folder_->get((*kept)->bytes.substr(kArtefactMark.size(), kArtefactNameDigits));
    if (!bytes) return fail(bytes.error());
    (*kept)->bytes = *std::move(bytes);
    return kept;
  }

  Result<int> forget_ended(const Retention& kept, std::int64_t now) override {
    auto forgotten = store_->forget_ended(kept, now);
    std::int64_t last = cleaned_ms_;
    const bool is_due = folder_ != nullptr && std::abs(now - last) > kHour_ms;
    if (!forgotten || !is_due || !cleaned_ms_.compare_exchange_strong(last, now)) return forgotten;
    // What is older than every job that is kept is none's. Where the clock was set, the earlier time holds.
    const auto jobs = store_->list(std::numeric_limits<std::int32_t>::max());
    if (!jobs) return fail(jobs.error());
    std::int64_t oldest = now - kept.most_age_ms;
    for (const Job& job : *jobs) oldest = std::min(oldest, job.created_ms);
    folder_->forget_before(oldest - kDay_ms);
    return forgotten;
  }

  Result<bool> split(const Lease& lease, const std::vector<std::string>& requests,
                     std::int64_t now) override {
    return store_->split(lease, requests, now);
  }
  Result<std::vector<Job>> parts(std::string_view id) override { return store_->parts(id); }
  Result<int> release(std::string_view worker, HandBack why, std::string_view reason) override {
    return store_->release(worker, why, reason);
  }
  Result<std::optional<Job>> dismiss(std::string_view id, std::int64_t now) override {
    return store_->dismiss(id, now);
  }
  Result<std::optional<Job>> get(std::string_view id) override { return store_->get(id); }
  Result<std::optional<std::string>> request(std::string_view id) override { return store_->request(id); }
  Result<std::optional<std::string>> outcome(std::string_view id) override { return store_->outcome(id); }
  Result<std::optional<QueuePlace>> place_in_queue(std::string_view id,
                                                   const std::vector<std::string>& kinds) override {
    return store_->place_in_queue(id, kinds);
  }
  Result<std::vector<JobCount>> counts() override { return store_->counts(); }
  Result<void> in_place() override { return store_->in_place(); }
  Result<std::vector<Job>> list(std::size_t most) override { return store_->list(most); }
  void listen(StoreNews news, std::function<void()> call) override { store_->listen(news, std::move(call)); }

 private:
  const std::unique_ptr<JobStore> store_;
  const std::shared_ptr<ArtefactFolder> folder_;
  std::atomic<std::int64_t> cleaned_ms_{0};
};

}  // namespace

std::unique_ptr<JobStore> with_artefacts(std::unique_ptr<JobStore> store,
                                         std::shared_ptr<ArtefactFolder> folder) {
  return std::make_unique<ArtefactJobStore>(std::move(store), std::move(folder));
}

}  // namespace slipway::api
