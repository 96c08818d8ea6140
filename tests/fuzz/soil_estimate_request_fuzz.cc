// The reader of requests for an estimate of a soil from tests.

#include "api/documents/soil/soil_estimate_request.h"
#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  const auto reading = api::json::read_soil_estimate_request(fuzz::text_of(data, size));
  fuzz::require(reading || !reading.error().detail.empty(), "a refusal says why");
  return 0;
}
