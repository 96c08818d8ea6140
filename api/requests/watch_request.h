#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api {

// POST /v1/watches asks, drive after drive, whether something has changed since drives that ship and are
// taken as healthy.
struct WatchRequest {
  std::string reference;                              // which these are
  std::shared_ptr<const gap::DriveCampaign> healthy;  // they
  gap::DriveCampaign watched;                         // the drives so far, in their order
  double alpha = 0.01;                                // see gap::ChangeOptions
  bool diagnose = true;                               // after an alarm
  std::vector<std::string> without;                   // effects that are left out of the search
  std::uint64_t seed = 1;
};

}  // namespace slipway::api
