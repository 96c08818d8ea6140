#include "api/service_diagnoses.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/documents/diagnosis/diagnosis_request.h"
#include "api/documents/diagnosis/watch_request.h"
#include "api/documents/soil/soil_estimate_request.h"
#include "api/files/campaign/drive_campaign_source.h"
#include "api/json/faults.h"
#include "api/uploads/uploaded_campaigns.h"
#include "gap/diagnosis/diagnosis.h"

namespace slipway::api {
namespace {

// Why there are no drives of this name; nothing where some ship or were sent.
std::optional<std::string> why_no_drives(const Service& service, const std::string& name) {
  std::vector<std::string> names;
  for (const ShippedCampaign& campaign : service.campaigns()) names.push_back(campaign.name);
  const bool ships = std::find(names.begin(), names.end(), name) != names.end();
  if (ships || (service.uploads() != nullptr && uploaded_campaign(*service.uploads(), name)))
    return std::nullopt;
  return unknown_name("campaign", name, names);
}

void check_campaign(const Service& service, const std::string& name, const std::string& pointer,
                    std::vector<Fault>& faults) {
  if (has_fault_under(faults, pointer)) return;
  if (const auto why = why_no_drives(service, name)) faults.push_back({pointer, *why});
}

// Errors: invalid_request at /campaign, and those of load_drive_campaign and of load_uploaded_campaign.
Result<gap::DriveCampaign> drives_of(const Service& service, const std::string& name) {
  if (const auto why = why_no_drives(service, name))
    return fail(ErrorCode::kInvalidRequest, *why, {{"/campaign", *why}});
  for (const ShippedCampaign& campaign : service.campaigns())
    if (campaign.name == name) return load_drive_campaign(campaign.folder, *service.catalogue());
  return load_uploaded_campaign(*service.uploads(), name, *service.catalogue());
}

// How effects are searched for, where a request has `without` and `seed`.
template <class Request>
gap::DiagnosisOptions search_of(const Request& request, const Service& service) {
  gap::DiagnosisOptions options;
  options.search.withheld = request.without;
  options.search.threads = service.options().threads;
  options.seed = request.seed;
  return options;
}

template <class Request>
Result<Request> faultless(Reading<Request>& reading) {
  if (reading.faults.empty()) return std::move(reading.request);
  return fail(ErrorCode::kInvalidRequest, summary_of(reading.faults), reading.faults);
}

}  // namespace

Result<DiagnosisRequest> read_diagnosis(const Service& service, std::string_view json) {
  auto reading = json::read_diagnosis_request(json);
  if (!reading) return fail(reading.error());
  std::vector<Fault>& faults = reading->faults;
  check_campaign(service, reading->request.campaign, "/campaign", faults);
  if (!reading->request.reference.empty())
    check_campaign(service, reading->request.reference, "/reference", faults);
  return faultless(*reading);
}

Result<ModelCheckRequest> read_model_check(const Service& service, std::string_view json) {
  auto reading = json::read_model_check_request(json);
  if (!reading) return fail(reading.error());
  check_campaign(service, reading->request.campaign, "/campaign", reading->faults);
  return faultless(*reading);
}

Result<WatchRequest> read_watch(const Service& service, std::string_view json) {
  auto reading =
      json::read_watch_request(json, [&](const std::string& name) { return drives_of(service, name); });
  if (!reading) return fail(reading.error());
  return faultless(*reading);
}

Result<SoilEstimateRequest> read_soil_estimate(const Service& service, std::string_view json) {
  auto reading = json::read_soil_estimate_request(json);
  if (!reading) return fail(reading.error());
  const SoilEstimateRequest& request = reading->request;
  std::vector<Fault>& faults = reading->faults;
  for (Fault& fault : faults_of(*service.catalogue(), request))
    if (!has_fault_under(faults, fault.pointer)) faults.push_back(std::move(fault));
  if (!request.campaign.empty()) check_campaign(service, request.campaign, "/campaign", faults);
  return faultless(*reading);
}

Result<DiagnosisAnswer> run_diagnosis(const Service& service, const DiagnosisRequest& request,
                                      Progress& progress) {
  progress.report("reading the drives", 0.0);
  auto campaign = drives_of(service, request.campaign);
  if (!campaign) return fail(campaign.error());
  Result<gap::Diagnosis> diagnosis;
  if (request.reference.empty()) {
    diagnosis = gap::diagnose(*campaign, search_of(request, service), progress);
  } else {
    const auto reference = drives_of(service, request.reference);
    if (!reference) return fail(reference.error());
    diagnosis = gap::diagnose_since(*reference, *campaign, search_of(request, service), progress);
  }
  if (!diagnosis) return fail(diagnosis.error());
  return DiagnosisAnswer{request, std::move(*campaign), std::move(*diagnosis)};
}

Result<ModelCheckAnswer> run_model_check(const Service& service, const ModelCheckRequest& request,
                                         Progress& progress) {
  progress.report("reading the drives", 0.0);
  const auto campaign = drives_of(service, request.campaign);
  if (!campaign) return fail(campaign.error());
  gap::ModelCheckOptions options;
  options.threads = service.options().threads;
  options.seed = request.seed;
  return check_model(*campaign, *request.model->corrected, request.model->ground, options, progress);
}

Result<WatchAnswer> run_watch(const Service& service, const WatchRequest& request, Progress& progress) {
  gap::WatchOptions watch;
  watch.learn = request.learn;
  watch.change.alpha = request.alpha;
  watch.diagnose = request.diagnose;
  auto watched =
      gap::watch_drives(request.watched, request.healthy.get(), watch, search_of(request, service), progress);
  if (!watched) return fail(watched.error());
  return WatchAnswer{*std::move(watched)};
}

Result<SoilEstimateAnswer> run_soil_estimate(const Service& service, const SoilEstimateRequest& request,
                                             Progress& progress) {
  if (request.campaign.empty()) return estimate_soil(*service.catalogue(), request, progress);
  progress.report("reading the drives", 0.0);
  const auto campaign = drives_of(service, request.campaign);
  if (!campaign) return fail(campaign.error());
  return estimate_soil(*campaign, request, service.options().threads, progress);
}

}  // namespace slipway::api
