#pragma once

#include <string>
#include <string_view>

#include "api/jobs/job_runner.h"
#include "api/service.h"

namespace slipway::api {

inline constexpr std::string_view kPlanKind = "plan";
inline constexpr std::string_view kPredictionKind = "prediction";
inline constexpr std::string_view kDiagnosisKind = "diagnosis";
inline constexpr std::string_view kSoilEstimateKind = "soil_estimate";

// What a job keeps: the answer's document and, of a diagnosis, its report as an HTML page behind it.
struct KeptAnswer {
  std::string_view document;
  std::string_view page;  // empty: none was kept
};
KeptAnswer parts_of(std::string_view kept);

// What a job runner does with the service's jobs: request bytes -> what is kept of the answer. The service
// must outlive it.
JobWork service_work(const Service& service);

}  // namespace slipway::api
