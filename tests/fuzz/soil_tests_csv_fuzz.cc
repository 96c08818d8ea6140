// The readers of wheel tests and plate tests.

#include "api/files/soil_tests_csv.h"
#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  const std::string_view text = fuzz::text_of(data, size);
  const auto wheels = api::read_wheel_tests_csv("tests.csv", text);
  fuzz::require(wheels || !wheels.error().detail.empty(), "a refusal says why");
  const auto plates = api::read_plate_tests_csv("tests.csv", text);
  fuzz::require(plates || !plates.error().detail.empty(), "a refusal says why");
  return 0;
}
