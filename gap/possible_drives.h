#pragma once

#include <span>
#include <vector>

#include "gap/diagnosis.h"
#include "gap/drive_campaign.h"
#include "gap/drive_window.h"

namespace slipway::gap {

// Drives that could be made next, as a campaign to predict: a window each, on a plane of the first soil.
struct PossibleDrives {
  std::vector<NextDrive> drives;  // information not told
  DriveCampaign campaign;
  // In the drives' order. Observations are the channels that the campaign measured, each with its usual size
  // there and the error with which it could be told.
  std::vector<DriveWindow> windows;
};

// On planes of up to 15 deg: straight in four directions, both senses and two speeds, warm and, where motor
// temperatures were recorded, cold; arcs where it is not steep. `made`: the campaign's own windows.
PossibleDrives possible_drives(const DriveCampaign& campaign, std::span<const DriveWindow> made);

}  // namespace slipway::gap
