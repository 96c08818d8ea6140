// The readers of SPICE kernels: an input is several files, with a line of four percent signs between them.

#include <string_view>
#include <vector>

#include "fuzz_target.h"
#include "steps/slip_steps_csv.h"
#include "steps/steps_from_spice.h"

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
  const auto found = steps::steps_from_spice(files);
  fuzz::require(found || !found.error().faults.empty(), "a refusal says where");
  if (!found || found->steps.empty()) return 0;
  const std::string text = steps::write_slip_steps(found->steps);
  const auto read = steps::read_slip_steps(text, "steps.csv");
  fuzz::require(read && read->size() == found->steps.size(), "the steps are a table that is read", text);
  return 0;
}
