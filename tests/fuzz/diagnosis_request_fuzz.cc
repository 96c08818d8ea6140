// The reader of requests for a diagnosis.

#include "api/documents/diagnosis/diagnosis_request.h"
#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  const auto reading = api::json::read_diagnosis_request(fuzz::text_of(data, size));
  fuzz::require(reading || !reading.error().detail.empty(), "a refusal says why");
  return 0;
}
