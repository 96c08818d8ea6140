#include "api/job_kind.h"

#include <stdexcept>

#include "api/continued_request.h"
#include "api/model_reference.h"

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

std::string kept_answer(const std::string& document, const std::string& page) {
  if (document.find(kBetweenParts) != std::string::npos)
    throw std::logic_error("a job's document must be one line");
  return document + kBetweenParts + page;
}

Result<std::string> recorded_request(std::string_view body, std::string_view kind, JobStore& store,
                                     NamesJob names,
                                     const std::function<std::optional<Error>(std::string_view)>& fault_of) {
  if (names == NamesJob::kModel) return recordable_request(body, store, fault_of);
  if (names == NamesJob::kContinued) return continued_request(body, kind, store, fault_of);
  if (auto fault = fault_of(body)) return fail(*std::move(fault));
  return std::string(body);
}

}  // namespace slipway::api
