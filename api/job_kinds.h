#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/job_kind.h"
#include "api/jobs/job_runner.h"
#include "api/service.h"

namespace slipway::api {

// Of those kinds that the code asks for by name: the command line's questions, and the job that offers a
// model.
inline constexpr std::string_view kPlanKind = "plan";
inline constexpr std::string_view kPredictionKind = "prediction";
inline constexpr std::string_view kCheckKind = "check";
inline constexpr std::string_view kSolKind = "sol";
inline constexpr std::string_view kDiagnosisKind = "diagnosis";
inline constexpr std::string_view kWatchKind = "watch";  // which has a diagnosis after an alarm

// The catalogue: every kind of job that the service does, one row each.
const std::vector<JobKind>& job_kinds();

// The row of this name; nullptr where there is none.
const JobKind* find_kind(const std::vector<JobKind>& kinds, std::string_view name);

// What a job runner does with jobs of these kinds: request bytes -> what is kept of the answer. The service
// and the kinds must outlive it.
JobWork service_work(const Service& service, const std::vector<JobKind>& kinds = job_kinds());

// How it divides the work on those jobs that several workers may share.
WorkInParts service_work_in_parts(const Service& service, const std::vector<JobKind>& kinds = job_kinds());

// The kinds that each worker of a runner claims: the first takes all, the second those that do not take long,
// the third short work alone, so that none waits behind longer work.
std::vector<std::vector<std::string>> worker_kinds(const std::vector<JobKind>& kinds = job_kinds());

}  // namespace slipway::api
