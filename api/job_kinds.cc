#include "api/job_kinds.h"

#include <fmt/format.h>

#include "api/documents/diagnosis_document.h"
#include "api/documents/plan_answer.h"
#include "api/documents/prediction_answer.h"
#include "api/documents/soil_estimate_document.h"
#include "api/report/diagnosis_charts.h"
#include "api/report/diagnosis_report.h"

namespace slipway::api {
namespace {

// No document has a line's end in it: within strings it is escaped.
constexpr char kBetweenParts = '\n';

}  // namespace

KeptAnswer parts_of(std::string_view kept) {
  const std::size_t end = kept.find(kBetweenParts);
  if (end == std::string_view::npos) return {kept, {}};
  return {kept.substr(0, end), kept.substr(end + 1)};
}

JobWork service_work(const Service& service) {
  return [&service](const std::string& kind, const std::string& request,
                    Progress& progress) -> Result<std::string> {
    // Read again from the bytes that were accepted: after a restart there is nothing else.
    if (kind == kPlanKind) {
      const auto plan_request = service.read_plan(request);
      if (!plan_request) return fail(plan_request.error());
      const auto answer = service.plan(*plan_request, progress);
      if (!answer) return fail(answer.error());
      return json::write_plan_answer(*answer);
    }
    if (kind == kPredictionKind) {
      const auto prediction_request = service.read_prediction(request);
      if (!prediction_request) return fail(prediction_request.error());
      const auto answer = service.predict(*prediction_request, progress);
      if (!answer) return fail(answer.error());
      return json::write_prediction_answer(*answer);
    }
    if (kind == kDiagnosisKind) {
      const auto diagnosis_request = service.read_diagnosis(request);
      if (!diagnosis_request) return fail(diagnosis_request.error());
      const auto answer = service.diagnose(*diagnosis_request, progress);
      if (!answer) return fail(answer.error());
      const gap::Diagnosis& d = answer->diagnosis;
      const ReportPage report = diagnosis_report(answer->campaign, d, draw_diagnosis(answer->campaign, d));
      return json::diagnosis_document(answer->campaign, d) + kBetweenParts + report.html();
    }
    if (kind == kSoilEstimateKind) {
      const auto estimate_request = service.read_soil_estimate(request);
      if (!estimate_request) return fail(estimate_request.error());
      const auto answer = service.estimate_soil(*estimate_request, progress);
      if (!answer) return fail(answer.error());
      return json::soil_estimate_document(*answer);
    }
    return fail(ErrorCode::kInternal, fmt::format("no work is known for jobs of kind {}", kind));
  };
}

}  // namespace slipway::api
