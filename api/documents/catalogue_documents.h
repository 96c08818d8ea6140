#pragma once

#include <span>
#include <string>

#include "api/files/campaign/shipped_campaigns.h"
#include "api/files/catalogue.h"
#include "api/json/writer.h"
#include "api/requests/answers.h"
#include "api/uploads/uploaded_campaigns.h"
#include "planner/problem/cost_catalogue.h"
#include "planner/search/planner_catalogue.h"

namespace slipway::api::json {

// What there is to ask for, each as {"<kind>": [...]}, sorted by name or in the catalogue's own order.
std::string write_terrains(const Catalogue& catalogue);
void write_terrain(Writer& w, const TerrainSite& site);  // one of them
std::string write_rovers(const Catalogue& catalogue);
std::string write_rules(const Catalogue& catalogue);
std::string write_soils(const Catalogue& catalogue);
std::string write_effects();
// Those that ship, and those that were sent.
std::string write_drive_campaigns(const std::vector<ShippedCampaign>& campaigns,
                                  const std::vector<UploadedCampaign>& sent = {});
// One that was sent.
std::string write_campaign_taken(const CampaignTaken& taken);
// The planners, with the cost terms that routes are searched and ranked by.
std::string write_planners(std::span<const planner::PlannerRow> planners = planner::planner_catalogue(),
                           std::span<const planner::CostTerm> costs = planner::cost_catalogue());
std::string write_errors();

std::string write_ground_at(const GroundAt& at);
std::string write_health();

}  // namespace slipway::api::json
