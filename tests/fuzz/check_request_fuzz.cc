// The reader of requests for a check of a path or a command sequence.

#include "api/documents/check_request.h"
#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  const std::map<std::string, api::RuleSet, std::less<>> rules{{"every_5_m", {}}};
  const auto reading = api::json::read_check_request(fuzz::text_of(data, size), rules);
  if (!reading || !reading->faults.empty()) return 0;
  const std::string written = api::json::write_check_request(reading->request);
  const auto again = api::json::read_check_request(written, rules);
  fuzz::require(again && again->faults.empty(), "a request without faults is written as one without faults",
                written);
  return 0;
}
