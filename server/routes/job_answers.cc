#include "server/routes/job_answers.h"

#include <fmt/format.h>
#include <malloc.h>

#include <fstream>
#include <memory>
#include <optional>
#include <utility>

#include "api/chart/report_page.h"
#include "api/documents/plan_answer.h"
#include "api/export/answer_vectors.h"
#include "api/export/station_csv.h"
#include "api/job_kinds.h"
#include "api/json/problem_document.h"
#include "server/routes/query.h"
#include "server/routes/request_headers.h"
#include "server/routes/responses.h"

namespace slipway::server {
namespace {

constexpr std::string_view kCsv = "text/csv";
constexpr std::string_view kGeoJson = "application/geo+json";
constexpr std::string_view kGeoPackage = "application/geopackage+sqlite3";
constexpr std::string_view kCloudOptimised = "image/tiff; application=geotiff; profile=cloud-optimized";
constexpr std::string_view kJsonLines = "application/jsonl";
constexpr std::string_view kHtml = "text/html; charset=utf-8";
constexpr std::string_view kSvg = "image/svg+xml";

// What a browser opens as a page of this service runs nothing and loads nothing.
void confine_page(HttpResponse& response) {
  response.headers.emplace_back("Content-Security-Policy",
                                fmt::format("{}; frame-ancestors 'self'", api::kReportPolicy));
  response.headers.emplace_back("X-Content-Type-Options", "nosniff");
}

}  // namespace

Result<api::Job> find_job(api::JobStore& store, const HttpRequest& request) {
  const auto job = store.get(request.parameter("id"));
  if (!job) return fail(job.error());
  if (!*job) return fail(ErrorCode::kNotFound, "there is no job of this id");
  return **job;
}

HttpResponse JobAnswers::result(const HttpRequest& request) {
  const auto job = find_job(store_, request);
  if (!job) return problem_response(job.error(), &request);
  return of(*job, request);
}

HttpResponse JobAnswers::stations(const HttpRequest& request) {
  Query query(request, {"page"});
  constexpr std::size_t kMostPages = 1'000'000;
  const auto page = static_cast<std::int64_t>(query.count("page", 1, kMostPages));
  if (const auto error = query.error()) return problem_response(*error, &request);
  const auto job = find_job(store_, request);
  if (!job) return problem_response(job.error(), &request);
  if (has_file(*job))
    return problem(ErrorCode::kNotFound, fmt::format("jobs of kind {} have no stations", job->kind), request);
  if (job->state != api::JobState::kSuccessful) return of(*job, request);
  auto table = page_of_stations(*job, page);
  if (!table) return problem_response(table.error(), &request);
  HttpResponse response = document(std::move(table->bytes));
  response.content_type = kCsv;
  if (table->more)
    response.headers.emplace_back(
        "Link", fmt::format("</v1/jobs/{}/stations?page={}>; rel=\"next\"", job->id, page + 1));
  const std::string tag = tag_of(response.body);
  return tagged(std::move(response), tag, request);
}

HttpResponse JobAnswers::answers(const HttpRequest& request) {
  const auto job = find_job(store_, request);
  if (!job) return problem_response(job.error(), &request);
  const api::JobKind* const kind = api::find_kind(kinds_, job->kind);
  if (kind == nullptr || !kind->has_lines || !job->whole.empty())
    return problem(ErrorCode::kNotFound, fmt::format("jobs of kind {} have one answer", job->kind), request);
  if (job->state != api::JobState::kSuccessful) return of(*job, request);
  auto lines = pieces_of(*job);
  if (!lines) return problem_response(lines.error(), &request);
  HttpResponse response = document({});
  response.pieces = *std::move(lines);
  response.content_type = kJsonLines;
  return tagged(std::move(response), fmt::format("\"{}\"", job->id), request);
}

HttpResponse JobAnswers::raster(const HttpRequest& request) {
  const auto job = find_job(store_, request);
  if (!job) return problem_response(job.error(), &request);
  const api::JobKind* const kind = api::find_kind(kinds_, job->kind);
  if (kind == nullptr || !kind->has_raster || !job->whole.empty())
    return problem(ErrorCode::kNotFound, fmt::format("jobs of kind {} have no raster", job->kind), request);
  if (job->state != api::JobState::kSuccessful) return of(*job, request);
  auto pages = pages_of(*job);
  if (!pages) return problem_response(pages.error(), &request);
  HttpResponse response = document({});
  response.content_type = kCloudOptimised;
  response.headers.emplace_back("Content-Disposition",
                                fmt::format("attachment; filename=\"{}.tif\"", job->id));
  return ranged(std::move(response), *std::move(pages), request);
}

HttpResponse JobAnswers::vectors(const HttpRequest& request, bool geopackage) {
  Query query(request, {"coordinates"});
  const std::string coordinates = request.query_value("coordinates").value_or("map");
  if (const auto error = query.error()) return problem_response(*error, &request);
  if (coordinates != "map" && (geopackage || coordinates != "lonlat"))
    return problem_response(
        {ErrorCode::kInvalidRequest,
         "The coordinates can't be had.",
         {{"/coordinates", geopackage ? "of a GeoPackage must be map" : "must be map or lonlat"}}},
        &request);
  const auto job = find_job(store_, request);
  if (!job) return problem_response(job.error(), &request);
  if (job->state != api::JobState::kSuccessful) return of(*job, request);
  const bool lonlat = coordinates == "lonlat";
  // SQLite opens a GeoPackage in place page by page: it is not made anew for each.
  const std::string form = geopackage ? "gpkg" : "geojson " + coordinates;
  const auto file = drawn_files_.get(fmt::format("{}/{}", job->id, form), [&] {
    auto made = DrawnFile::make(drawing_folder_, [&](const std::filesystem::path& path) {
      return write_vectors(*job, geopackage, lonlat, path);
    });
    ::malloc_trim(0);  // the whole answer was in memory, and nothing as large may come for long
    return made;
  });
  if (!file) return problem_response(file.error(), &request);
  HttpResponse response = document({});
  response.content_type = geopackage ? kGeoPackage : kGeoJson;
  return ranged(std::move(response), DrawnFile::body(*file), request);
}

HttpResponse JobAnswers::map(const HttpRequest& request) {
  const auto job = find_job(store_, request);
  if (!job) return problem_response(job.error(), &request);
  const api::JobKind* const kind = api::find_kind(kinds_, job->kind);
  if (kind == nullptr || !kind->map)
    return problem(ErrorCode::kNotFound, fmt::format("jobs of kind {} have no map", job->kind), request);
  if (job->state != api::JobState::kSuccessful) return of(*job, request);
  const auto svg = drawn_.get(job->id + "/map", [&]() -> Result<std::string> {
    const auto kept = kept_outcome(*job);
    if (!kept) return fail(kept.error());
    return kind->map(*service_.catalogue(), api::parts_of(*kept).document);
  });
  if (!svg) return problem_response(svg.error(), &request);
  HttpResponse response = document(**svg);
  response.content_type = kSvg;
  confine_page(response);
  const std::string tag = tag_of(response.body);
  return tagged(std::move(response), tag, request);
}

HttpResponse JobAnswers::report(const HttpRequest& request) {
  const auto job = find_job(store_, request);
  if (!job) return problem_response(job.error(), &request);
  const api::JobKind* const kind = api::find_kind(kinds_, job->kind);
  if (kind == nullptr || !kind->has_report)
    return problem(ErrorCode::kNotFound, fmt::format("jobs of kind {} have no report", job->kind), request);
  if (job->state != api::JobState::kSuccessful) return of(*job, request);
  const auto page = drawn_.get(job->id + "/report", [&]() -> Result<std::string> {
    const auto kept = kept_outcome(*job);
    if (!kept) return fail(kept.error());
    const api::KeptAnswer parts = api::parts_of(*kept);
    if (kind->page) return kind->page(*service_.catalogue(), parts.document);
    if (parts.page.empty()) return fail(ErrorCode::kNotFound, "the job's report is not kept");
    return std::string(parts.page);
  });
  if (!page) return problem_response(page.error(), &request);
  HttpResponse response = document(**page);
  response.content_type = kHtml;
  confine_page(response);
  const std::string tag = tag_of(response.body);
  return tagged(std::move(response), tag, request);
}

bool JobAnswers::has_file(const api::Job& job) const {
  const api::JobKind* const kind = api::find_kind(kinds_, job.kind);
  return kind != nullptr && (kind->has_raster || kind->has_lines);
}

Result<BodyPieces> JobAnswers::pieces_of(const api::Job& job) {
  auto first = store_.series(job.id, 1);
  if (!first) return fail(first.error());
  if (!*first) return fail(ErrorCode::kNotFound, "the job's result is no longer kept");
  return [this, id = job.id, next = *std::move(first),
          page = std::int64_t{1}]() mutable -> Result<std::optional<std::string>> {
    if (!next) return std::nullopt;
    const bool more = next->more;
    std::string bytes = std::exchange(next, std::nullopt)->bytes;
    if (more) {
      auto following = store_.series(id, ++page);
      if (!following) return fail(following.error());
      if (!*following) return fail(ErrorCode::kNotFound, "the job was forgotten while its result was sent");
      next = *std::move(following);
    }
    return bytes;
  };
}

Result<PagedBody> JobAnswers::pages_of(const api::Job& job) {
  PagedBody body;
  body.tag = fmt::format("\"{}\"", job.id);
  body.read = [this, id = job.id](std::size_t page) -> Result<std::string> {
    auto kept = store_.series(id, static_cast<std::int64_t>(page) + 1);
    if (!kept) return fail(kept.error());
    if (!*kept) return fail(ErrorCode::kNotFound, "the job's result is no longer kept");
    return (*kept)->bytes;
  };
  {
    const std::scoped_lock lock(page_bytes_mutex_);
    if (const auto known = page_bytes_.find(job.id); known != page_bytes_.end()) {
      body.page_bytes = known->second;
      return body;
    }
  }
  const auto pieces = pieces_of(job);
  if (!pieces) return fail(pieces.error());
  for (;;) {
    const auto piece = (*pieces)();
    if (!piece) return fail(piece.error());
    if (!*piece) break;
    body.page_bytes.push_back((*piece)->size());
  }
  const std::scoped_lock lock(page_bytes_mutex_);
  if (page_bytes_.size() >= kMostJobsPaged) page_bytes_.clear();
  page_bytes_[job.id] = body.page_bytes;
  return body;
}

Result<void> JobAnswers::write_vectors(const api::Job& job, bool geopackage, bool lonlat,
                                       const std::filesystem::path& path) {
  const auto kept = kept_outcome(job);
  if (!kept) return fail(kept.error());
  const std::string_view answer = api::parts_of(*kept).document;
  if (!api::json::has_stations(answer))
    return fail(ErrorCode::kNotFound, fmt::format("jobs of kind {} have no routes", job.kind));
  const std::shared_ptr<const api::Catalogue> catalogue = service_.catalogue();
  const api::json::AnsweredTerrain terrain = api::json::terrain_of_answer(answer);
  const auto site = api::terrain_at(*catalogue, terrain.name, terrain.version);
  if (!site) return fail(site.error());
  const dem::ElevationInfo& info = (*site)->info();
  const api::json::AnswerMap map{info.crs_name, info.crs_wkt, info.body, info.semi_major_axis_m,
                                 info.geometry.extent()};
  api::json::TablePages stations;
  if (api::json::is_thinned(answer)) {
    auto pages = pieces_of(job);
    if (!pages) return fail(pages.error());
    stations = *std::move(pages);
  }
  if (geopackage) return api::json::write_answer_geopackage(answer, map, std::move(stations), path);
  using api::json::VectorCoordinates;
  std::ofstream file(path, std::ios::binary);
  return api::json::write_answer_geojson(
      answer, map, lonlat ? VectorCoordinates::kLongitudeLatitude : VectorCoordinates::kMap,
      std::move(stations), [&](std::string_view bytes) -> Result<void> {
        file.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush();
        if (file) return {};
        return fail(ErrorCode::kStorage, "the vectors can't be written");
      });
}

Result<api::SeriesPage> JobAnswers::page_of_stations(const api::Job& job, std::int64_t page) {
  auto kept = store_.series(job.id, page);
  if (!kept) return fail(kept.error());
  if (*kept) return **std::move(kept);
  if (page > 1) return fail(ErrorCode::kNotFound, fmt::format("the job's stations have no page {}", page));
  const auto answer = kept_outcome(job);
  if (!answer) return fail(answer.error());
  auto csv = api::json::station_csv(api::parts_of(*answer).document);
  if (!csv) return fail(csv.error());
  return api::SeriesPage{.bytes = *std::move(csv)};
}

Result<std::string> JobAnswers::kept_outcome(const api::Job& job) {
  auto outcome = store_.outcome(job.id);
  if (!outcome) return fail(std::move(outcome.error()));
  if (!*outcome) return fail(ErrorCode::kNotFound, "the job's result is no longer kept");
  return **std::move(outcome);
}

HttpResponse JobAnswers::of(const api::Job& job, const HttpRequest& request) {
  if (job.state == api::JobState::kDismissed)
    return problem(ErrorCode::kCancelled, "the job was dismissed", request);
  if (!api::has_ended(job.state)) {
    HttpResponse response =
        problem(ErrorCode::kConflict,
                fmt::format("the job is {}: it has no result yet", api::describe(job.state)), request);
    response.headers.emplace_back("Retry-After", std::to_string(kPollSeconds));
    return response;
  }
  const auto kept = kept_outcome(job);
  if (!kept) return problem_response(kept.error(), &request);
  if (job.state == api::JobState::kFailed) {
    return problem_response(api::json::read_problem(*kept), &request);
  }
  return answer(job, std::string(api::parts_of(*kept).document), request);
}

// The stations of a thinned answer are all there, and come page by page.
HttpResponse JobAnswers::csv_answer(const api::Job& job, const std::string& bytes,
                                    const HttpRequest& request) {
  HttpResponse response = document({});
  response.content_type = kCsv;
  if (api::json::is_thinned(bytes)) {
    auto pieces = pieces_of(job);
    if (!pieces) return problem_response(pieces.error(), &request);
    response.pieces = *std::move(pieces);
  } else {
    auto csv = api::json::station_csv(bytes);
    if (!csv) return problem_response(csv.error(), &request);
    response.body = *std::move(csv);
  }
  return response;
}

HttpResponse JobAnswers::answer(const api::Job& job, const std::string& bytes, const HttpRequest& request) {
  HttpResponse response = document(bytes);
  std::string tag;
  if (accepts(request, kCsv) && api::json::has_stations(bytes)) {
    response = csv_answer(job, bytes, request);
    if (response.pieces) tag = fmt::format("\"{}-csv\"", job.id);
  } else if (accepts(request, kGeoJson)) {
    auto geojson = api::json::geojson_of(bytes);
    if (!geojson) return problem_response(geojson.error(), &request);
    response.body = *std::move(geojson);
    response.content_type = kGeoJson;
  }
  if (response.status != 200) return response;
  response.headers.emplace_back("Vary", "Accept");
  if (tag.empty()) tag = tag_of(response.body);
  return request.method == "POST" ? response : tagged(std::move(response), tag, request);
}

}  // namespace slipway::server
