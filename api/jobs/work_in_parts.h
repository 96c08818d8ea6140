#pragma once

#include <functional>
#include <string>
#include <vector>

#include "api/jobs/job_store.h"
#include "core/progress.h"

namespace slipway::api {

// What a job of some kind does with its request: the answer's bytes. It asks progress.cancelled() at least
// every 100 ms.
using JobWork =
    std::function<Result<JobAnswer>(const std::string& kind, const std::string& request, Progress&)>;

// The answer of the job's part of this number.
using PartAnswer = std::function<Result<JobAnswer>(int part)>;

// Work that several workers may share. The same bytes come of it however many of them there are, and of the
// same work done in one go.
struct WorkInParts {
  // The requests of the parts, in the order in which they are put together. Fewer than two: it is done in one
  // go. Quick, as it is done before the job is divided.
  std::function<Result<std::vector<std::string>>(const std::string& kind, const std::string& request)> split;
  JobWork part;
  std::function<Result<JobAnswer>(const std::string& kind, const std::string& request, const PartAnswer&,
                                  Progress&)>
      put_together;
};

// The answer of a job all of whose parts have ended. Errors: that of the first part without an answer, with
// the number and the reason of each; those of the store and of the work.
Result<JobAnswer> put_together(JobStore& store, const WorkInParts& in_parts, const ClaimedJob& claimed,
                               Progress& progress);

}  // namespace slipway::api
