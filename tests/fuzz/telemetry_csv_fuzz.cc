// The reader of a drive's telemetry, and the stretches that are made of it.

#include <cmath>

#include "api/files/telemetry_csv.h"
#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  const auto drive = api::read_telemetry_csv(fuzz::text_of(data, size), "telemetry.csv");
  fuzz::require(drive || !drive.error().faults.empty(), "a refusal says where");
  if (!drive) return 0;
  for (const planner::TelemetryStretch& stretch : planner::stretches_of(*drive, {"lf", "rf"})) {
    fuzz::require(stretch.measured.rolled_m > 0.0, "the wheels roll on every stretch");
    fuzz::require(std::isfinite(stretch.measured.slip_ratio()), "a slip is a number");
    fuzz::require(stretch.rows.size() >= 2, "a stretch has two ends");
  }
  return 0;
}
