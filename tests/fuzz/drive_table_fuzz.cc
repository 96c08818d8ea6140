// The reader of tables of drives to simulate ("campaign-table/1").

#include "api/files/drive_table/drive_table_file.h"
#include "fuzz_target.h"
#include "shipped_catalogue.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  const auto table = api::json::read_campaign_table(
      fuzz::text_of(data, size), SLIPWAY_DATA_FOLDER "/campaigns", fuzz::shipped_catalogue());
  fuzz::require(table || !table.error().detail.empty(), "a refusal says why");
  return 0;
}
