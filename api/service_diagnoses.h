#pragma once

#include <string_view>

#include "api/requests/answers.h"
#include "api/requests/model_check.h"
#include "api/requests/soil_estimate.h"
#include "api/service.h"
#include "core/progress.h"

// What recorded drives show: diagnoses, watches, checks of corrected models, estimates of soils.
namespace slipway::api {

// Each reads a request and checks its values and names. All faults together.
Result<DiagnosisRequest> read_diagnosis(const Service& service, std::string_view json);
Result<ModelCheckRequest> read_model_check(const Service& service, std::string_view json);
Result<WatchRequest> read_watch(const Service& service, std::string_view json);
Result<SoilEstimateRequest> read_soil_estimate(const Service& service, std::string_view json);

// The same request gives the same answer, on any number of threads.
Result<DiagnosisAnswer> run_diagnosis(const Service& service, const DiagnosisRequest& request,
                                      Progress& progress);
Result<ModelCheckAnswer> run_model_check(const Service& service, const ModelCheckRequest& request,
                                         Progress& progress);
Result<WatchAnswer> run_watch(const Service& service, const WatchRequest& request, Progress& progress);
Result<SoilEstimateAnswer> run_soil_estimate(const Service& service, const SoilEstimateRequest& request,
                                             Progress& progress);

}  // namespace slipway::api
