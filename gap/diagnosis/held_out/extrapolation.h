#pragma once

#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/held_out/held_out.h"
#include "gap/diagnosis/model/drive_resampling.h"
#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/diagnosis_options.h"

namespace slipway::gap {

// What a correction learnt from the gentle drives is worth on the harsh ones: along the slope, the cold and
// the speed of drives as far as the campaign has them, the harshest third is told from the rest.
Result<std::vector<Extrapolation>> extrapolate(const PreparedCampaign& prepared,
                                               const DriveCampaign& campaign, const Correction& correction,
                                               const DriveResampling& drives, const DiagnosisOptions& options,
                                               Progress& progress);

}  // namespace slipway::gap
