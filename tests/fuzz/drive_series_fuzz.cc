// The reader of a recorded drive's CSV.

#include <string>
#include <vector>

#include "api/files/campaign/drive_series_csv.h"
#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  static const std::vector<std::string> wheels{"lf", "lm", "lr", "rf", "rm", "rr"};
  constexpr std::size_t kMaxRows = 1000;
  const api::DriveSeries series =
      api::read_drive_series(fuzz::text_of(data, size), "D001.csv", wheels, kMaxRows);
  fuzz::require(series.samples.size() <= kMaxRows, "no more rows are kept than were asked for");
  for (const auto& sample : series.samples)
    fuzz::require(sample.wheels.size() == wheels.size(), "every row has a reading for each wheel");
  for (const std::string& name : series.passed_over) (void)api::column_meant(name, wheels);
  return 0;
}
