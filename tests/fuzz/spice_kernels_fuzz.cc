// The readers of SPICE kernels: an input is several files, with a line of four percent signs between them.

#include <cmath>
#include <string_view>
#include <vector>

#include "fuzz_target.h"
#include "steps/kernel_sky.h"
#include "steps/slip_steps_csv.h"
#include "steps/steps_from_spice.h"

namespace {

// The same files as the source of a sky, at some times within and beside what the corpus has.
void look_at_the_sky(const std::vector<slipway::steps::KernelBytes>& files) {
  using namespace slipway;
  for (const std::string_view body : {"Mars", "Moon"}) {
    const auto sky = steps::KernelSky::read(files, body);
    fuzz::require(sky || !sky.error().detail.empty(), "a refusal says why");
    if (!sky) continue;
    for (const std::int64_t utc_ms : {946'728'000'000LL, 946'767'600'000LL, 1'458'637'200'000LL}) {
      const auto seen = sky->over({0.3, -1.2}, utc_ms);
      fuzz::require(seen || !seen.error().detail.empty(), "a refusal says why");
      if (!seen) continue;
      for (const double number : {seen->sun.azimuth_rad, seen->sun.elevation_rad, seen->earth->azimuth_rad,
                                  seen->earth->elevation_rad, seen->sun_distance_au})
        fuzz::require(std::isfinite(number), "what is seen is numbers");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  constexpr std::string_view kBetween = "\n%%%%\n";
  std::vector<steps::KernelBytes> files;
  std::string_view rest = fuzz::text_of(data, size);
  for (std::size_t end = 0; end != std::string_view::npos;) {
    end = rest.find(kBetween);
    files.push_back({"kernel", rest.substr(0, end)});
    if (end != std::string_view::npos) rest.remove_prefix(end + kBetween.size());
  }
  look_at_the_sky(files);
  const auto found = steps::steps_from_spice(files);
  fuzz::require(found || !found.error().faults.empty(), "a refusal says where");
  if (!found || found->steps.empty()) return 0;
  const std::string text = steps::write_slip_steps(found->steps);
  const auto read = steps::read_slip_steps(text, "steps.csv");
  fuzz::require(read && read->size() == found->steps.size(), "the steps are a table that is read", text);
  return 0;
}
