#include "api/job_kind.h"

#include <stdexcept>

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

Result<std::string> recorded_request(std::string_view body, JobStore& store, bool may_name_model,
                                     const std::function<std::optional<Error>(std::string_view)>& fault_of) {
  if (may_name_model) return recordable_request(body, store, fault_of);
  if (auto fault = fault_of(body)) return fail(*std::move(fault));
  return std::string(body);
}

}  // namespace slipway::api
