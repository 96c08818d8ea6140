#include "yard_requests.h"

#include "api/documents/check_answer.h"
#include "api/documents/check_request.h"
#include "api/json/parse.h"
#include "api/service_drives.h"
#include "small_world.h"

namespace slipway::api::testing {

std::string YardRequests::with(const std::string& members) const {
  return R"({"terrain":"yard","rover":")" + rover_ + R"(",)" + members + "}";
}

Result<json::JsonValue> YardRequests::checked(const std::string& members) const {
  const auto read = read_check(small_world(), with(members));
  if (!read) return fail(read.error());
  NoProgress progress;
  const auto answer = run_check(small_world(), *read, progress);
  if (!answer) return fail(answer.error());
  return json::parse(json::write_check_answer(*answer));
}

std::vector<std::string> YardRequests::faults_of(const std::string& members) const {
  const auto read = read_check(small_world(), with(members));
  std::vector<std::string> pointers;
  if (!read)
    for (const Fault& fault : read.error().faults) pointers.push_back(fault.pointer);
  return pointers;
}

}  // namespace slipway::api::testing
