#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api {

// POST /v1/watches asks, drive after drive, whether something has changed since drives that are taken as
// healthy: those of a reference, or the first of the campaign that is watched.
struct WatchRequest {
  std::string campaign;  // whose drives are watched; empty where the request has them itself
  int learn = 12;  // first drives of the campaign that are taken as healthy, where no reference is given
  std::string reference;                              // which these are
  std::shared_ptr<const gap::DriveCampaign> healthy;  // they; null where the first drives are
  gap::DriveCampaign watched;                         // the drives so far, in their order
  double alpha = 0.01;                                // see gap::ChangeOptions
  bool diagnose = true;                               // after an alarm
  std::vector<std::string> without;                   // effects that are left out of the search
  std::uint64_t seed = 1;
};

}  // namespace slipway::api
