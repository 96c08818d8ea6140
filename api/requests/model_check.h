#pragma once

#include <string>
#include <vector>

#include "api/files/model_folder.h"
#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/model/drive_campaign.h"
#include "gap/diagnosis/model_check.h"

namespace slipway::api {

// The rover and soils of a campaign according to a model that was corrected with another campaign. A soil is
// replaced by the model's where it has the name that it had there, or where it is among `ground`. Errors:
// invalid_request with every name that the model does not replace, at /rover/name, /soils/NAME and /ground/I.
Result<gap::CorrectedBelief> belief_of(const gap::DriveCampaign& campaign, const ModelFolder& model,
                                       const std::vector<std::string>& ground);

struct ModelCheckAnswer {
  std::string campaign, fingerprint;  // of the campaign whose drives were predicted
  std::string corrected_with;         // the model's campaign
  std::string rover;                  // the corrected one
  std::vector<std::string> soils;
  std::uint64_t seed = 1;
  gap::ModelCheck check;
  std::vector<std::string> notes;  // what the intervals account for, and what was left out
};

// Errors: those of belief_of; cancelled.
Result<ModelCheckAnswer> check_model(const gap::DriveCampaign& campaign, const ModelFolder& model,
                                     const std::vector<std::string>& ground,
                                     const gap::ModelCheckOptions& options, Progress& progress);

}  // namespace slipway::api
