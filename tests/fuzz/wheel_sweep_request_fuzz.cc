// The reader of requests for sweeps of one wheel.

#include "api/documents/soil/wheel_sweep_request.h"
#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  const auto reading = api::json::read_wheel_sweep_request(fuzz::text_of(data, size));
  if (!reading || !reading->faults.empty()) return 0;
  const std::string written = api::json::write_wheel_sweep_request(reading->request);
  const auto again = api::json::read_wheel_sweep_request(written);
  fuzz::require(again && again->faults.empty(), "a request without faults is written as one without faults",
                written);
  fuzz::require(api::json::write_wheel_sweep_request(again->request) == written,
                "a request that was written reads back as the same request", written);
  return 0;
}
