#pragma once

#include <string>

#include "api/files/campaign/drive_import.h"

namespace slipway::api {

// What was read of recorded drives, as an SVG: the drives on the map, and their attitudes, wheels' rates,
// currents and sinkages over time.
std::string import_chart(const ImportedCampaign& campaign);

}  // namespace slipway::api
