#pragma once

#include <string_view>

#include "api/requests/answers.h"
#include "api/service.h"
#include "core/progress.h"

// Plans, predictions and checks of drives.
namespace slipway::api {

// Each reads a request and checks all that can be checked without planning: syntax, values, names, whether
// every place lies on the terrain and has elevation. All faults together. off_map or no_data when all of them
// are of that kind.
Result<PlanRequest> read_plan(const Service& service, std::string_view json);
Result<PredictionRequest> read_prediction(const Service& service, std::string_view json);
Result<CheckRequest> read_check(const Service& service, std::string_view json);

// The same request gives the same answer, on any number of threads.
Result<PlanAnswer> run_plan(const Service& service, const PlanRequest& request, Progress& progress);
Result<PredictionAnswer> run_prediction(const Service& service, const PredictionRequest& request,
                                        Progress& progress);
Result<CheckAnswer> run_check(const Service& service, const CheckRequest& request, Progress& progress);

}  // namespace slipway::api
