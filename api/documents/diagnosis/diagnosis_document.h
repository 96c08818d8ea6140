#pragma once

#include <string>
#include <vector>

#include "api/files/corrected_model.h"
#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api::json {

// "diagnosis/1": the verdict, what was compared, where the gap is and how far it closes, next drives, and
// the corrected model. The same diagnosis gives the same bytes; units are those of the boundary.
std::string diagnosis_document(const gap::DriveCampaign& campaign, const gap::Diagnosis& diagnosis);

// A rover's file and a soils' file of a corrected model, for data/rovers and data/soils.
std::string rover_document(const CorrectedModel& model);
std::string soils_document(const CorrectedModel& model);

// Every set that was compared once, ways of one effect together, most probable first; probabilities add up to
// 1, and "nothing" and "unknown" are among them. Where nothing was compared these two are alike.
std::vector<gap::ComparedSet> compared_sets(const gap::Diagnosis& diagnosis);

// A drive that is expected to bring fewer bits than this is not offered: twenty such drives would tell as
// much as one question that is answered with yes or no.
inline constexpr double kLeastOfferedBits = 0.05;
// Those of a diagnosis' next drives that are offered: it has weaker ones too, in their order of information.
std::vector<gap::NextDrive> offered_drives(const gap::Diagnosis& diagnosis);

}  // namespace slipway::api::json
