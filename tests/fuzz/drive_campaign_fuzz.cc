// The reader of campaign.json of recorded drives ("drive-campaign/1").

#include "api/files/campaign/drive_campaign_file.h"
#include "fuzz_target.h"
#include "shipped_catalogue.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  const auto campaign =
      api::json::read_drive_campaign_file(fuzz::text_of(data, size), fuzz::shipped_catalogue());
  fuzz::require(campaign || !campaign.error().detail.empty(), "a refusal says why");
  if (campaign && campaign->faults.empty())
    fuzz::require(campaign->rover != nullptr, "a campaign without faults has a rover");
  return 0;
}
