#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "api/requests/plan_request.h"
#include "api/requests/watch_request.h"
#include "core/result.h"

namespace slipway::api::json {

// How large a watch may grow, drive after drive, as it is recorded.
inline constexpr std::size_t kMaxWatchBytes = std::size_t{32} << 20U;

// The drives that ship under a name, or why there are none.
using ShippedDrives = std::function<Result<gap::DriveCampaign>(const std::string&)>;

// Errors where the bytes are no JSON document, or drives that ship can't be read; everything else is a fault
// in the reading.
Result<Reading<WatchRequest>> read_watch_request(std::string_view bytes, const ShippedDrives& shipped);

}  // namespace slipway::api::json
