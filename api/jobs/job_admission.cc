#include "api/jobs/job_admission.h"

#include <fmt/format.h>
#include <fmt/printf.h>

namespace slipway::api {

std::optional<Error> refused_by(const Admission& admission, std::int64_t unfinished,
                                std::int64_t unfinished_of_owner) {
  if (static_cast<std::size_t>(unfinished) >= admission.most_unfinished)
    return Error{
        ErrorCode::kTooManyJobs, fmt::format("{} jobs are waiting or running already", unfinished), {}};
  if (static_cast<std::size_t>(unfinished_of_owner) >= admission.most_of_owner)
    return Error{ErrorCode::kOverQuota,
                 fmt::format("{} of your jobs are waiting or running already, as many as one client may have",
                             unfinished_of_owner),
                 {}};
  return std::nullopt;
}

Error another_request() {
  return {ErrorCode::kInvalidRequest,
          "the key was used for another request",
          {{"/Idempotency-Key", "names a request of another kind or with another body; take a new key"}}};
}

Job accepted_job(const NewJob& wanted, std::int64_t now) {
  Job job;
  job.id = wanted.id;
  job.kind = wanted.kind;
  job.created_ms = now;
  job.owner = wanted.owner;
  job.urgency = wanted.urgency;
  return job;
}

NewJob new_part(const Job& whole, const std::string& request) {
  return {.id = new_job_id(),
          .kind = whole.kind,
          .request = request,
          .owner = whole.owner,
          .urgency = whole.urgency};
}

std::string stage_of_parts(int ended, int count) {
  return fmt::sprintf(kStageOfParts, std::to_string(ended), std::to_string(count));
}

double progress_of_parts(int ended, int count) {
  return kShareOfParts * ended / count;
}

int parts_at_once(const JobParts& parts, int most) {
  return std::max(1, std::min(most, (parts.count - parts.ended) / kShareAtOnce));
}

void QueueSum::add(bool running, int count, std::optional<double> each_s) {
  constexpr double kLeftOfRunning = 0.5;
  if (!running) ahead_ += count;
  if (each_s)
    work_s_ += (running ? kLeftOfRunning : 1.0) * count * *each_s;
  else
    known_ = false;
}

QueuePlace QueueSum::place() const {
  return {.ahead = ahead_, .work_ahead_s = known_ ? std::optional(work_s_) : std::nullopt};
}

}  // namespace slipway::api
