#pragma once

#include <cstddef>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/model/drive_campaign.h"
#include "gap/diagnosis/search/prepared_campaign.h"
#include "gap/estimate/soil_estimation.h"

namespace slipway::gap {

// What is left over in one channel of the drives, in its own unit and in deviations of the drives' scatter.
struct DriveChannelResidual {
  Channel channel = Channel::kSlip;
  std::size_t count = 0;
  double rms = 0.0, rms_deviations = 0.0;
};

struct DriveSoilEstimate {
  // In the campaign's order. Of readings, open directions and the model's evaluations they say nothing; the
  // spread of the soil holds the drives' scatter from one to the next besides what the estimate leaves open.
  std::vector<SoilEstimate> soils;
  std::vector<DriveChannelResidual> channels;
  std::size_t windows = 0;  // that were used
};

// The soils that recorded drives show, by the fit that a diagnosis begins with (prepared_campaign.h): soils,
// closures of the laws and the motors' torque constant are re-tuned together at the quasi-static fidelity
// level, under the drives' own scatter. Of each soil k_bekker, n, cohesion, friction angle and shear modulus,
// with the priors of the nuisance catalogue. Intervals are Laplace's, at 90 % and of the data without the
// parameter's own prior. `looked_at` is by channel; empty: all are. With the
// current alone it is the Zhurong paper's question.
//
// Errors: cancelled; no_data where no window has a reading that is looked at.
Result<DriveSoilEstimate> estimate_soils_of_drives(const DriveCampaign& campaign,
                                                   const std::vector<bool>& looked_at, std::size_t threads,
                                                   Progress& progress);

}  // namespace slipway::gap
