#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/jobs/job_runner.h"
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

// One kind of job as a row of the catalogue: what a client posts, what is done with it, and what can be seen
// of the answer. Routes, runner and command line work from these rows alone. Thread-safe.
template <class Request, class Answer>
struct JobKindRow {
  std::string name;  // under which jobs are stored and shown: "plan"
  std::string path;  // where requests are posted: "/v1/plans"
  // The request in a body, or every fault of it together. A body that was accepted is read again when the job
  // runs.
  std::function<Result<Request>(const Service&, std::string_view body)> read;
  // The answer. It asks progress.cancelled() at least every 100 ms.
  std::function<Result<Answer>(const Service&, const Request&, Progress&)> run;
  // The answer as a JSON document on one line.
  std::function<std::string(const Answer&)> write;
  // A picture (SVG) of an answer's document, drawn when it is asked for; empty: this kind has no map.
  std::function<Result<std::string>(const Catalogue&, std::string_view document)> map = nullptr;
  // An HTML page of an answer's document, made when it is asked for; empty: there is none, or `report` has
  // it.
  std::function<Result<std::string>(const Catalogue&, std::string_view document)> page = nullptr;
  // An HTML page, written with the answer and kept beside it; empty: this kind has no report.
  std::function<std::string(const Answer&)> report = nullptr;
  std::chrono::seconds usual_wait{
      0};                       // how long the client's POST waits for the answer unless it says otherwise
  bool is_short = false;        // runs on the worker for short work too, and so not behind long work
  bool may_name_model = false;  // the request may name a diagnosis whose model it is answered with
  bool may_continue = false;    // the request may continue an earlier one: see continued_request.h
};

// A row whose types of request and answer are hidden in its functions.
struct JobKind {
  std::string name;
  std::string path;
  // The request's bytes as they are to be recorded: the body, with the model in it where it names one, or
  // what it continues. Errors: those of the row's `read`; with a model also invalid_request at /model, with
  // what it continues at /continues; and storage.
  std::function<Result<std::string>(const Service&, JobStore&, std::string_view body)> accept;
  // What is to be kept of the answer to a recorded request.
  std::function<Result<std::string>(const Service&, std::string_view recorded, Progress&)> work;
  std::function<Result<std::string>(const Catalogue&, std::string_view document)> map;  // may be empty
  std::function<Result<std::string>(const Catalogue&, std::string_view document)> page =
      nullptr;              // may be empty
  bool has_report = false;  // made when it is asked for, where there is `page`, or else kept with the answer
  std::chrono::seconds usual_wait{0};
  bool is_short = false;
};

// The recorded form of a request that `fault_of` finds no fault in; see JobKind::accept.
enum class NamesJob { kNone, kModel, kContinued };
Result<std::string> recorded_request(std::string_view body, std::string_view kind, JobStore& store,
                                     NamesJob names,
                                     const std::function<std::optional<Error>(std::string_view)>& fault_of);

template <class Request, class Answer>
JobKind job_kind(JobKindRow<Request, Answer> of) {
  const auto row = std::make_shared<const JobKindRow<Request, Answer>>(std::move(of));
  JobKind kind{.name = row->name, .path = row->path, .accept = {}, .work = {}, .map = row->map};
  kind.page = row->page;
  kind.has_report = row->report != nullptr || row->page != nullptr;
  kind.usual_wait = row->usual_wait;
  kind.is_short = row->is_short;
  kind.accept = [row](const Service& service, JobStore& store, std::string_view body) {
    const NamesJob names = row->may_name_model ? NamesJob::kModel
                           : row->may_continue ? NamesJob::kContinued
                                               : NamesJob::kNone;
    return recorded_request(body, row->name, store, names,
                            [&](std::string_view request) -> std::optional<Error> {
                              const auto read = row->read(service, request);
                              return read ? std::nullopt : std::optional<Error>(read.error());
                            });
  };
  kind.work = [row](const Service& service, std::string_view recorded,
                    Progress& progress) -> Result<std::string> {
    // Read again from the bytes that were accepted: after a restart there is nothing else.
    const auto request = row->read(service, recorded);
    if (!request) return fail(request.error());
    const auto answer = row->run(service, *request, progress);
    if (!answer) return fail(answer.error());
    return row->report ? kept_answer(row->write(*answer), row->report(*answer)) : row->write(*answer);
  };
  return kind;
}

}  // namespace slipway::api
