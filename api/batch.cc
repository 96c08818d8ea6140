#include "api/batch.h"

#include <fmt/format.h>

#include <utility>

#include "api/documents/batch_document.h"
#include "api/job_kinds.h"
#include "api/json/faults.h"
#include "core/part_of_progress.h"

namespace slipway::api {
namespace {

// A part is the kind of its request, and the request in the next line.
std::string part_of(const BatchRequest& batch, std::size_t number) {
  return fmt::format("{}\n{}", batch.kind, batch.requests[number]);
}

}  // namespace

Result<BatchRequest> read_batch(const Service& service, std::string_view body) {
  auto reading = json::read_batch_request(body);
  if (!reading) return fail(reading.error());
  BatchRequest& batch = reading->request;
  const JobKind* const kind = find_kind(job_kinds(), batch.kind);
  std::vector<Fault> faults = std::move(reading->faults);
  constexpr std::size_t kMaxFaults = 50;
  for (std::size_t k = 0; kind != nullptr && k < batch.requests.size() && faults.size() < kMaxFaults;
       k += batch.seeds) {
    const auto terrains = kind->terrains(service, batch.requests[k]);
    if (terrains) {
      batch.terrains.insert(batch.terrains.end(), terrains->begin(), terrains->end());
      continue;
    }
    const Error& wrong = terrains.error();
    const std::string place = fmt::format("/requests/{}", k / batch.seeds);
    if (wrong.faults.empty()) faults.push_back({place, wrong.detail});
    for (const Fault& fault : wrong.faults) faults.push_back({place + fault.pointer, fault.message});
  }
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  return std::move(reading->request);
}

Result<BatchAnswer> run_batch(const Service& service, const BatchRequest& request, Progress& progress) {
  BatchAnswer answer{request.kind, {}};
  const auto share = 1.0 / static_cast<double>(request.requests.size());
  for (std::size_t k = 0; k < request.requests.size(); ++k) {
    const auto begun = static_cast<double>(k) * share;
    PartOfProgress one(progress, begun, begun + share);
    auto part = batch_part(service, part_of(request, k), one);
    if (!part) return fail(part.error());
    answer.documents.push_back(std::move(part->bytes));
  }
  return answer;
}

std::string batch_lines(const BatchAnswer& answer) {
  std::string lines;
  for (const std::string& document : answer.documents) lines += document + "\n";
  return lines;
}

std::vector<std::string> batch_parts(const Service& /*service*/, const BatchRequest& request,
                                     std::string_view /*recorded*/) {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < request.requests.size(); ++k) parts.push_back(part_of(request, k));
  return parts;
}

Result<JobAnswer> batch_part(const Service& service, std::string_view part, Progress& progress) {
  const std::size_t head = part.find('\n');
  const JobKind* const kind = find_kind(job_kinds(), part.substr(0, head));
  if (kind == nullptr) return fail(ErrorCode::kInternal, "a part of the batch is of an unknown kind");
  auto answer = kind->work(service, part.substr(head + 1), progress);
  if (!answer) return fail(answer.error());
  return JobAnswer(std::string(parts_of(answer->bytes).document));
}

Result<BatchAnswer> put_batch_together(const Service& /*service*/, const BatchRequest& request,
                                       const PartAnswer& parts, Progress& progress) {
  BatchAnswer answer{request.kind, {}};
  for (std::size_t k = 0; k < request.requests.size(); ++k) {
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the batch was given up");
    auto part = parts(static_cast<int>(k));
    if (!part) return fail(part.error());
    answer.documents.push_back(std::move(part->bytes));
  }
  return answer;
}

}  // namespace slipway::api
