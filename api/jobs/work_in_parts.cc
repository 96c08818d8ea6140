#include "api/jobs/work_in_parts.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "api/json/problem_document.h"

namespace slipway::api {
namespace {

Result<JobAnswer> answer_of_part(JobStore& store, const Job& part) {
  if (part.state == JobState::kDismissed) return fail(ErrorCode::kCancelled, "the part was dismissed");
  auto outcome = store.outcome(part.id);
  if (!outcome) return fail(outcome.error());
  if (!*outcome) return fail(ErrorCode::kInternal, "the part has no answer");
  if (part.state == JobState::kFailed) return fail(json::read_problem(**outcome));
  JobAnswer answer(**std::move(outcome));
  for (std::int64_t page = 1;; ++page) {
    auto read = store.series(part.id, page);
    if (!read) return fail(read.error());
    if (!*read) return answer;
    answer.series.push_back(std::move((*read)->bytes));
  }
}

}  // namespace

Result<JobAnswer> put_together(JobStore& store, const WorkInParts& in_parts, const ClaimedJob& claimed,
                               Progress& progress) {
  progress.report("putting the parts together", 0.0);
  const auto parts = store.parts(claimed.job.id);
  if (!parts) return fail(parts.error());
  std::optional<Error> missing;
  for (const Job& part : *parts) {
    if (part.state == JobState::kSuccessful) continue;
    const auto answer = answer_of_part(store, part);
    if (!missing)
      missing = Error{answer.error().code,
                      fmt::format("{} of {} parts of the work are missing: {}", claimed.job.parts.failed,
                                  parts->size(), answer.error().detail),
                      {}};
    missing->faults.push_back({fmt::format("/parts/{}", part.part), answer.error().detail});
  }
  if (missing) return fail(*std::move(missing));
  return in_parts.put_together(
      claimed.job.kind, claimed.request,
      [&](int part) { return answer_of_part(store, parts->at(static_cast<std::size_t>(part))); }, progress);
}

}  // namespace slipway::api
