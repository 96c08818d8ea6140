// The reader of tables of measured slip: what it takes is written and read again.

#include "fuzz_target.h"
#include "steps/slip_steps_csv.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  const auto read = steps::read_slip_steps(fuzz::text_of(data, size), "steps.csv");
  fuzz::require(read || !read.error().faults.empty(), "a refusal says where");
  if (!read) return 0;
  // Rounded odometry may be 0, which is no step any more.
  for (const steps::SlipStep& step : *read)
    if (step.odometry_m < 1e-3) return 0;
  const std::string text = steps::write_slip_steps(*read);
  const auto again = steps::read_slip_steps(text, "written.csv");
  fuzz::require(again && again->size() == read->size(), "what is written is read again", text);
  fuzz::require(steps::write_slip_steps(*again) == text, "and written as it was", text);
  return 0;
}
