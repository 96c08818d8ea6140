#include "api/jobs/job_store.h"

namespace slipway::api {

Result<LeaseTerm> JobStore::lease_term(std::chrono::milliseconds length) {
  const auto now = lease_clock();
  if (!now) return fail(now.error());
  return LeaseTerm{*now, *now + length.count()};
}

Result<std::optional<ClaimedJob>> JobStore::claim(std::string_view worker,
                                                  const std::vector<std::string>& kinds, std::int64_t now,
                                                  std::int64_t lease_until) {
  auto claimed = claim_some(worker, kinds, now, LeaseTerm{now, lease_until}, 1);
  if (!claimed) return fail(claimed.error());
  if (claimed->empty()) return std::nullopt;
  return std::move(claimed->front());
}

Result<bool> JobStore::finish(const Lease& lease, JobState state, const JobAnswer& outcome,
                              std::int64_t now) {
  const auto kept = finish_all({{lease, state, outcome}}, now);
  if (!kept) return fail(kept.error());
  return kept->front();
}

}  // namespace slipway::api
