#pragma once

#include <string>

#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api {

// The map of the gap, as an SVG document: for each terrain a row of three maps (nominal, re-tuned, with the
// effects) of the windows of held-out drives on the hillshade, coloured by how far prediction and measurement
// differ, with the places where a diagnosis says the gap sits. Empty where no window was compared.
std::string draw_gap_map(const gap::DriveCampaign& campaign, const gap::Diagnosis& diagnosis);

}  // namespace slipway::api
