#pragma once

#include <string>

#include "api/job_runner.h"
#include "api/service.h"

namespace slipway::api {

inline constexpr std::string_view kPlanKind = "plan";
inline constexpr std::string_view kPredictionKind = "prediction";
inline constexpr std::string_view kDiagnosisKind = "diagnosis";
inline constexpr std::string_view kSoilEstimateKind = "soil_estimate";

// What a job runner does with the service's jobs: request bytes -> answer bytes. The service must outlive it.
JobWork service_work(const Service& service);

}  // namespace slipway::api
