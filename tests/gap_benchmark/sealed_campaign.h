#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "campaign_case.h"
#include "drive_simulation.h"
#include "terrain_grid.h"

namespace slipway::gap_benchmark {

struct NamedTerrain {
  std::string name;
  TerrainGrid grid;
};

struct MadeDrive {
  DriveOrder order;
  std::vector<DriveRow> rows;
  std::uint64_t soil_seed = 0;  // of the scatter of its soil
};

// A campaign with all its data, including the hidden ones.
struct SealedCampaign {
  CampaignCase made_of;
  World world;
  TrueSoil nominal;
  EffectAnswers effects;
  std::vector<NamedTerrain> terrains;
  std::vector<MadeDrive> drives;
  std::uint64_t noise_seed = 0;
};

SealedCampaign make_campaign(const CampaignCase& made_of, RandomStream& random);

// Drives made after the others, of the same rover on the same ground with the same cause: numbers and hours
// go on, the others stay as they are. Only on tables.
void add_drives(SealedCampaign& campaign, std::vector<DriveOrder> orders, RandomStream& random);

// Drives of the same rover on the same ground and soil before anything was hidden in it: other drives, with
// scatter and noise of their own.
SealedCampaign healthy_reference(const SealedCampaign& campaign, RandomStream& random);

// Writes campaign.json, the drives and the terrains. Returns an error message, or nothing.
std::string write_campaign(const SealedCampaign& campaign, const std::string& name,
                           const std::filesystem::path& folder);

// One member of answers.json, as text.
std::string answer_of(const SealedCampaign& campaign);

}  // namespace slipway::gap_benchmark
