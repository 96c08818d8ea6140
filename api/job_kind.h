#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/export/station_csv.h"
#include "api/jobs/job_runner.h"
#include "api/plan_reference.h"
#include "api/recorded_request.h"
#include "api/service.h"

namespace slipway::api {

// What a job keeps: the answer's document and, of kinds that have one, its report as an HTML page behind it.
struct KeptAnswer {
  std::string_view document;
  std::string_view page;  // empty: none was kept
};
KeptAnswer parts_of(std::string_view kept);
// The document, which must be one line, and the page in the form that parts_of() takes apart.
std::string kept_answer(const std::string& document, const std::string& page);

// How long jobs of a kind usually take: seconds, a minute, many. None waits behind those of a longer lane.
enum class Lane { kShort, kUsual, kLong };

// The table of all stations that a whole document has, as CSV in pages of a megabyte or so: put together they
// are one table.
Result<std::vector<std::string>> series_of(std::string_view whole);

// A file in pieces of a megabyte or so: put together they are the file.
std::vector<std::string> in_pieces(std::string_view file);

// One kind of job as a row of the catalogue: what a client posts, what is done with it, and what can be seen
// of the answer. Routes, runner and command line work from these rows alone. Thread-safe.
template <class Request, class Answer>
struct JobKindRow {
  std::string name;  // under which jobs are stored and shown: "plan"
  std::string path;  // where requests are posted: "/v1/plans"
  // The request in a body, or every fault of it together. A body that was accepted is read again when the job
  // runs.
  std::function<Result<Request>(const Service&, std::string_view body)> read;
  // Makes what is asked for the asker's; empty: the answer is all that is made. Errors: conflict where the
  // name that it is to have is somebody else's.
  std::function<Result<void>(const Service&, Request&, const Asker&)> claim = nullptr;
  // The answer. It asks progress.cancelled() at least every 100 ms.
  std::function<Result<Answer>(const Service&, const Request&, Progress&)> run;
  // The answer as a JSON document on one line; of a long drive with some of its stations.
  std::function<std::string(const Answer&)> write;
  // The same with all stations, whose table is kept in pages where `write` has left some out; empty: it
  // leaves out nothing.
  std::function<std::string(const Answer&)> write_whole = nullptr;
  // A picture (SVG) of an answer's document, drawn when it is asked for; empty: this kind has no map.
  std::function<Result<std::string>(const Catalogue&, std::string_view document)> map = nullptr;
  // An HTML page of an answer's document, made when it is asked for; empty: there is none, or `report` has
  // it.
  std::function<Result<std::string>(const Catalogue&, std::string_view document)> page = nullptr;
  // An HTML page, written with the answer and kept beside it; empty: this kind has no report.
  std::function<std::string(const Answer&)> report = nullptr;
  // The bytes of a file that belongs to the answer, kept beside it in pieces: a raster (GeoTIFF). Empty:
  // there is none.
  std::function<std::string(const Answer&)> raster = nullptr;
  // Of kinds that answer several requests: all answers, one a line, kept in pieces too. Empty: none.
  std::function<std::string(const Answer&)> lines = nullptr;
  // Work that several workers may share, see WorkInParts: the requests of its parts, the answer to one of
  // them, and that of the whole. Empty: it is done in one go.
  std::function<std::vector<std::string>(const Service&, const Request&, std::string_view recorded)> split =
      nullptr;
  std::function<Result<JobAnswer>(const Service&, std::string_view part, Progress&)> part = nullptr;
  std::function<Result<Answer>(const Service&, const Request&, const PartAnswer&, Progress&)> put_together =
      nullptr;
  std::chrono::seconds usual_wait{
      0};                       // how long the client's POST waits for the answer unless it says otherwise
  Lane lane = Lane::kUsual;     // see worker_kinds()
  bool may_name_model = false;  // the request may name a diagnosis whose model it is answered with
  bool may_continue = false;    // the request may continue an earlier one: see continued_request.h
  bool may_name_plan = false;   // the request may name a route of a plan: see plan_reference.h
};

// A row whose types of request and answer are hidden in its functions.
struct JobKind {
  std::string name;
  std::string path;
  // The request's bytes as they are to be recorded, see RecordedRequest: the body, with the model in it where
  // it names one, or what it continues. Errors: those of the row's `read` and `claim`; with a model also
  // invalid_request at /model, with what it continues at /continues; and storage.
  std::function<Result<std::string>(const Service&, JobStore&, const Asker&, std::string_view body)> accept;
  // What is to be kept of the answer to a recorded request. Errors: conflict where the ground is another than
  // when it was asked for, see on_its_ground().
  std::function<Result<JobAnswer>(const Service&, std::string_view recorded, Progress&)> work;
  std::function<Result<std::string>(const Catalogue&, std::string_view document)> map;  // may be empty
  std::function<Result<std::string>(const Catalogue&, std::string_view document)> page =
      nullptr;              // may be empty
  bool has_report = false;  // made when it is asked for, where there is `page`, or else kept with the answer
  bool has_raster = false;  // its pieces are the job's series
  bool has_lines = false;   // their pieces are
  // The terrains that a body is about, where it names no other job. Errors: those of `accept`.
  std::function<Result<std::vector<std::string>>(const Service&, std::string_view body)> terrains = nullptr;
  // May be empty, see JobKindRow.
  std::function<Result<std::vector<std::string>>(const Service&, std::string_view recorded)> split = nullptr;
  std::function<Result<JobAnswer>(const Service&, std::string_view part, Progress&)> part = nullptr;
  std::function<Result<JobAnswer>(const Service&, std::string_view recorded, const PartAnswer&, Progress&)>
      put_together = nullptr;
  std::chrono::seconds usual_wait{0};
  Lane lane = Lane::kUsual;
};

// The recorded form of a request that `fault_of` finds no fault in; see JobKind::accept.
enum class NamesJob { kNone, kModel, kContinued };
Result<std::string> recorded_request(std::string_view body, std::string_view kind, JobStore& store,
                                     NamesJob names,
                                     const std::function<std::optional<Error>(std::string_view)>& fault_of);

// What is to be kept of an answer.
template <class Request, class Answer>
Result<JobAnswer> kept_of(const JobKindRow<Request, Answer>& row, const Result<Answer>& answer) {
  if (!answer) return fail(answer.error());
  std::string document = row.write(*answer);
  if (row.raster) return JobAnswer(std::move(document), in_pieces(row.raster(*answer)));
  if (row.lines) return JobAnswer(std::move(document), in_pieces(row.lines(*answer)));
  if (row.report) return JobAnswer(kept_answer(document, row.report(*answer)));
  if (!row.write_whole || !json::is_thinned(document)) return JobAnswer(std::move(document));
  auto series = series_of(row.write_whole(*answer));
  if (!series) return fail(series.error());
  return JobAnswer(std::move(document), *std::move(series));
}

// Where a request says of which terrains it is.
template <class Request>
std::vector<std::string> terrains_of(const Request& request) {
  if constexpr (requires { request.terrain; })
    return {request.terrain};
  else if constexpr (requires { request.terrains; })
    return request.terrains;
  else
    return {};
}

template <class Request, class Answer>
Result<Request> read_of(const JobKindRow<Request, Answer>& row, const Service& service, const Asker& asker,
                        std::string_view body) {
  auto request = row.read(service, body);
  if (!request || !row.claim) return request;
  if (auto claimed = row.claim(service, *request, asker); !claimed) return fail(claimed.error());
  return request;
}

template <class Request, class Answer>
JobKind job_kind(JobKindRow<Request, Answer> of) {
  const auto row = std::make_shared<const JobKindRow<Request, Answer>>(std::move(of));
  JobKind kind{.name = row->name, .path = row->path, .accept = {}, .work = {}, .map = row->map};
  kind.page = row->page;
  kind.has_report = row->report != nullptr || row->page != nullptr;
  kind.has_raster = row->raster != nullptr;
  kind.has_lines = row->lines != nullptr;
  kind.usual_wait = row->usual_wait;
  kind.lane = row->lane;
  kind.accept = [row](const Service& service, JobStore& store, const Asker& asker,
                      std::string_view posted) -> Result<std::string> {
    const auto body = row->may_name_plan ? with_plans_route(posted, store) : Result<std::string>(posted);
    if (!body) return body;
    const NamesJob names = row->may_name_model ? NamesJob::kModel
                           : row->may_continue ? NamesJob::kContinued
                                               : NamesJob::kNone;
    std::vector<std::string> terrains;
    auto recorded = recorded_request(*body, row->name, store, names,
                                     [&](std::string_view request) -> std::optional<Error> {
                                       const auto read = read_of(*row, service, asker, request);
                                       if (!read) return read.error();
                                       terrains = terrains_of(*read);
                                       return std::nullopt;
                                     });
    if (recorded) recorded->insert(0, request_head(service, asker, terrains));
    return recorded;
  };
  kind.work = [row](const Service& service, std::string_view recorded,
                    Progress& progress) -> Result<JobAnswer> {
    return on_its_ground(service, recorded, [&](const RecordedRequest& kept) -> Result<JobAnswer> {
      // Read again from the bytes that were accepted: after a restart there is nothing else.
      const auto request = read_of(*row, service, kept.asker, kept.body);
      if (!request) return fail(request.error());
      return kept_of(*row, row->run(service, *request, progress));
    });
  };
  kind.terrains = [row](const Service& service, std::string_view body) -> Result<std::vector<std::string>> {
    const auto read = row->read(service, body);
    if (!read) return fail(read.error());
    return terrains_of(*read);
  };
  if (!row->split) return kind;
  kind.split = [row](const Service& service, std::string_view recorded) -> Result<std::vector<std::string>> {
    const RecordedRequest kept = taken_apart(recorded);
    const auto request = read_of(*row, service, kept.asker, kept.body);
    if (!request) return fail(request.error());
    std::vector<std::string> parts = row->split(service, *request, kept.body);
    for (std::string& part : parts) part.insert(0, kept.head);
    return parts;
  };
  kind.part = [row](const Service& service, std::string_view part, Progress& progress) {
    return on_its_ground(service, part, [&](const RecordedRequest& kept) -> Result<JobAnswer> {
      return row->part(service, kept.body, progress);
    });
  };
  kind.put_together = [row](const Service& service, std::string_view recorded, const PartAnswer& parts,
                            Progress& progress) -> Result<JobAnswer> {
    return on_its_ground(service, recorded, [&](const RecordedRequest& kept) -> Result<JobAnswer> {
      const auto request = read_of(*row, service, kept.asker, kept.body);
      if (!request) return fail(request.error());
      return kept_of(*row, row->put_together(service, *request, parts, progress));
    });
  };
  return kind;
}

}  // namespace slipway::api
