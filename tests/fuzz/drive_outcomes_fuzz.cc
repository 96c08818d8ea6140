// The readers of tables of past drives and of sets of rules.

#include "api/files/drive_outcomes.h"
#include "api/files/drive_rules.h"
#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  const auto table = api::read_drive_outcomes(fuzz::text_of(data, size));
  fuzz::require(table || !table.error().detail.empty(), "a refusal says why");
  if (table)
    for (const api::PastDrive& drive : table->drives)
      fuzz::require(drive.path.size() >= 2, "a drive has a path");
  const auto rules = api::json::read_rules_file(fuzz::text_of(data, size));
  fuzz::require(rules || !rules.error().detail.empty(), "a refusal says why");
  return 0;
}
