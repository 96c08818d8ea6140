#pragma once

#include <string_view>

#include "api/service.h"
#include "api/uploads/uploaded_campaigns.h"
#include "api/uploads/uploaded_terrains.h"

// What clients send: terrains beside those that ship, and drive campaigns.
namespace slipway::api {

// All faults together; invalid_request where Service::uploads() has none.
Result<CampaignOrder> read_campaign(const Service& service, std::string_view json);
Result<TerrainOrder> read_terrain(const Service& service, std::string_view json);

}  // namespace slipway::api
