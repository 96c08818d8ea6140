#include "api/job_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "api/batch.h"
#include "api/documents/batch_document.h"
#include "api/documents/catalogue_documents.h"
#include "api/documents/check_answer.h"
#include "api/documents/diagnosis/diagnosis_document.h"
#include "api/documents/diagnosis/model_check_document.h"
#include "api/documents/diagnosis/watch_document.h"
#include "api/documents/plan_answer.h"
#include "api/documents/prediction_answer.h"
#include "api/documents/soil/soil_estimate_document.h"
#include "api/documents/sol_document.h"
#include "api/maps/map_documents.h"
#include "api/report/check_report.h"
#include "api/report/diagnosis_charts.h"
#include "api/report/diagnosis_report.h"
#include "api/report/route_map.h"
#include "api/report/sol_report.h"
#include "api/service_diagnoses.h"
#include "api/service_drives.h"
#include "api/service_map.h"
#include "api/service_sol.h"
#include "api/service_uploads.h"

namespace slipway::api {
namespace {

using json::StationDetail;

std::string diagnosis_page(const DiagnosisAnswer& answer) {
  return diagnosis_report(answer.campaign, answer.diagnosis,
                          draw_diagnosis(answer.campaign, answer.diagnosis))
      .html();
}

MapTarget served_map() {
  MapTarget target;
  target.max_cells = kMaxServedMapCells;
  return target;
}

// A map that is too large is refused before it is a job.
Result<MapRequest> read_served_map(const Service& service, std::string_view body) {
  auto request = read_map(service, body);
  if (!request) return request;
  if (auto size = check_map_size(service, *request, kMaxServedMapCells); !size) return fail(size.error());
  return request;
}

// Each part of a map is a square of tiles: its first row and column, then the map's own request.
std::vector<std::string> map_parts(const Service& service, const MapRequest& request,
                                   std::string_view recorded) {
  std::vector<std::string> parts;
  const auto pieces = map_pieces(service, request);
  if (!pieces) return parts;
  for (const auto& [row, column] : *pieces) parts.push_back(fmt::format("{} {}\n{}", row, column, recorded));
  return parts;
}

Result<JobAnswer> map_part(const Service& service, std::string_view part, Progress& progress) {
  const std::size_t head = part.find('\n');
  MapPieceIndex piece;
  std::istringstream(std::string(part.substr(0, head))) >> piece.row >> piece.column;
  const auto request = read_map(service, part.substr(head + 1));
  if (!request) return fail(request.error());
  auto tiles = map_piece(service, *request, served_map(), piece, progress);
  if (!tiles) return fail(tiles.error());
  return JobAnswer("tiles", *std::move(tiles));
}

Result<MapAnswer> put_map_together(const Service& service, const MapRequest& request, const PartAnswer& parts,
                                   Progress& progress) {
  return map_of_pieces(
      service, request, served_map(),
      [&](int piece) -> Result<std::vector<std::string>> {
        auto answer = parts(piece);
        if (!answer) return fail(answer.error());
        return std::move(answer->series);
      },
      progress);
}

template <class Answer, std::string (*Write)(const Answer&, json::StationDetail), json::StationDetail Detail>
std::string written(const Answer& answer) {
  return Write(answer, Detail);
}

std::vector<JobKind> all_kinds() {
  return {
      job_kind(JobKindRow<PlanRequest, PlanAnswer>{
          .name = std::string(kPlanKind),
          .path = "/v1/plans",
          .read = &read_plan,
          .run = &run_plan,
          .write = &written<PlanAnswer, &json::write_plan_answer, StationDetail::kThinned>,
          .write_whole = &written<PlanAnswer, &json::write_plan_answer, StationDetail::kWhole>,
          .map = &draw_route_map,
          .may_name_model = true}),
      job_kind(JobKindRow<PredictionRequest, PredictionAnswer>{
          .name = std::string(kPredictionKind),
          .path = "/v1/predictions",
          .read = &read_prediction,
          .run = &run_prediction,
          .write = &written<PredictionAnswer, &json::write_prediction_answer, StationDetail::kThinned>,
          .write_whole = &written<PredictionAnswer, &json::write_prediction_answer, StationDetail::kWhole>,
          .map = &draw_route_map,
          .usual_wait = std::chrono::seconds(10),
          .lane = Lane::kShort,
          .may_name_model = true}),
      job_kind(JobKindRow<CheckRequest, CheckAnswer>{
          .name = std::string(kCheckKind),
          .path = "/v1/checks",
          .read = &read_check,
          .run = &run_check,
          .write = &written<CheckAnswer, &json::write_check_answer, StationDetail::kThinned>,
          .write_whole = &written<CheckAnswer, &json::write_check_answer, StationDetail::kWhole>,
          .map = &draw_route_map,
          .page = &check_report,
          .usual_wait = std::chrono::seconds(10),
          .lane = Lane::kShort,
          .may_name_model = true,
          .may_name_plan = true}),
      job_kind(JobKindRow<PlanRequest, SolAnswer>{.name = std::string(kSolKind),
                                                  .path = "/v1/sols",
                                                  .read = &read_sol,
                                                  .run = &run_sol,
                                                  .write = &json::write_sol,
                                                  .page = &sol_report,
                                                  .may_name_model = true}),
      job_kind(JobKindRow<DiagnosisRequest, DiagnosisAnswer>{.name = std::string(kDiagnosisKind),
                                                             .path = "/v1/diagnoses",
                                                             .read = &read_diagnosis,
                                                             .run = &run_diagnosis,
                                                             .write =
                                                                 [](const DiagnosisAnswer& answer) {
                                                                   return json::diagnosis_document(
                                                                       answer.campaign, answer.diagnosis);
                                                                 },
                                                             .report = &diagnosis_page,
                                                             .lane = Lane::kLong}),
      job_kind(JobKindRow<ModelCheckRequest, ModelCheckAnswer>{.name = "model_check",
                                                               .path = "/v1/model-checks",
                                                               .read = &read_model_check,
                                                               .run = &run_model_check,
                                                               .write = &json::model_check_document,
                                                               .usual_wait = std::chrono::seconds(10),
                                                               .lane = Lane::kShort,
                                                               .may_name_model = true}),
      job_kind(JobKindRow<WatchRequest, WatchAnswer>{
          .name = std::string(kWatchKind),
          .path = "/v1/watches",
          .read = &read_watch,
          .run = &run_watch,
          .write = [](const WatchAnswer& answer) { return json::watch_document(answer.watch); },
          .usual_wait = std::chrono::seconds(10),
          .may_continue = true}),
      job_kind(JobKindRow<SoilEstimateRequest, SoilEstimateAnswer>{.name = "soil_estimate",
                                                                   .path = "/v1/soil-estimates",
                                                                   .read = &read_soil_estimate,
                                                                   .run = &run_soil_estimate,
                                                                   .write = &json::soil_estimate_document,
                                                                   .lane = Lane::kShort}),
      job_kind(JobKindRow<CampaignOrder, CampaignTaken>{
          .name = "drive_campaign",
          .path = "/v1/drive-campaigns",
          .read = &read_campaign,
          .claim = [](const Service& /*service*/, CampaignOrder& order, const Asker& asker) -> Result<void> {
            order.asker = asker;
            return {};
          },
          .run =
              [](const Service& service, const CampaignOrder& order, Progress& progress) {
                return take_campaign(*service.uploads(), order, *service.catalogue(), progress);
              },
          .write = &json::write_campaign_taken,
          .usual_wait = std::chrono::seconds(20),
          .lane = Lane::kShort}),
      job_kind(JobKindRow<TerrainOrder, TerrainImportReport>{
          .name = "terrain",
          .path = "/v1/terrains",
          .read = &read_terrain,
          .claim = [](const Service& service, TerrainOrder& order,
                      const Asker& asker) { return claim_terrain(*service.uploads(), order, asker); },
          .run =
              [](const Service& service, const TerrainOrder& order, Progress& progress) {
                return take_terrain(*service.uploads(), order, *service.catalogue(), progress);
              },
          .write =
              [](const TerrainImportReport& report) { return report.json.substr(0, report.json.find('\n')); },
          .usual_wait = std::chrono::seconds(20)}),
      job_kind(JobKindRow<MapRequest, MapAnswer>{
          .name = "map",
          .path = "/v1/maps",
          .read = &read_served_map,
          .run = [](const Service& service, const MapRequest& request,
                    Progress& progress) { return run_map(service, request, served_map(), progress); },
          .write = &json::write_map_answer,
          .raster = [](const MapAnswer& answer) { return answer.cog; },
          .split = &map_parts,
          .part = &map_part,
          .put_together = &put_map_together}),
      job_kind(JobKindRow<BatchRequest, BatchAnswer>{.name = "batch",
                                                     .path = "/v1/batches",
                                                     .read = &read_batch,
                                                     .run = &run_batch,
                                                     .write = &json::write_batch_answer,
                                                     .lines = &batch_lines,
                                                     .split = &batch_parts,
                                                     .part = &batch_part,
                                                     .put_together = &put_batch_together}),
  };
}

}  // namespace

const std::vector<JobKind>& job_kinds() {
  static const std::vector<JobKind> kinds = all_kinds();
  return kinds;
}

const JobKind* find_kind(const std::vector<JobKind>& kinds, std::string_view name) {
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const JobKind& kind) { return kind.name == name; });
  return found == kinds.end() ? nullptr : &*found;
}

JobWork service_work(const Service& service, const std::vector<JobKind>& kinds) {
  return [&service, &kinds](const std::string& kind, const std::string& request,
                            Progress& progress) -> Result<JobAnswer> {
    const JobKind* const known = find_kind(kinds, kind);
    if (known == nullptr)
      return fail(ErrorCode::kInternal, fmt::format("no work is known for jobs of kind {}", kind));
    return known->work(service, request, progress);
  };
}

WorkInParts service_work_in_parts(const Service& service, const std::vector<JobKind>& kinds) {
  const auto unknown = [](const std::string& kind) {
    return fail(ErrorCode::kInternal, fmt::format("jobs of kind {} are not done in parts", kind));
  };
  WorkInParts work;
  work.split = [&service, &kinds](const std::string& kind,
                                  const std::string& request) -> Result<std::vector<std::string>> {
    const JobKind* const known = find_kind(kinds, kind);
    if (known == nullptr || !known->split) return std::vector<std::string>();
    return known->split(service, request);
  };
  work.part = [&service, &kinds, unknown](const std::string& kind, const std::string& part,
                                          Progress& progress) -> Result<JobAnswer> {
    const JobKind* const known = find_kind(kinds, kind);
    if (known == nullptr || !known->part) return unknown(kind);
    return known->part(service, part, progress);
  };
  work.put_together = [&service, &kinds, unknown](const std::string& kind, const std::string& request,
                                                  const PartAnswer& parts,
                                                  Progress& progress) -> Result<JobAnswer> {
    const JobKind* const known = find_kind(kinds, kind);
    if (known == nullptr || !known->put_together) return unknown(kind);
    return known->put_together(service, request, parts, progress);
  };
  return work;
}

std::vector<std::vector<std::string>> worker_kinds(const std::vector<JobKind>& kinds) {
  std::vector<std::vector<std::string>> workers;
  for (const Lane longest : {Lane::kLong, Lane::kUsual, Lane::kShort}) {
    std::vector<std::string> names;
    for (const JobKind& kind : kinds)
      if (kind.lane <= longest) names.push_back(kind.name);
    if (!names.empty() && (workers.empty() || names != workers.back())) workers.push_back(std::move(names));
  }
  return workers;
}

}  // namespace slipway::api
