#pragma once

#include <string_view>

namespace slipway::server {

// What every command of slipway ends with.
enum ExitStatus : int {
  kDone = 0,       // done, and of a drive or a plan: GO
  kFailed = 1,     // the work failed, or its output could not be written
  kBadInput = 2,   // a command or an input that can't be used, with every fault
  kNoGo = 3,       // the drive or the best route is NO-GO, or there is no route
  kUndecided = 4,  // the drive or the best route is UNKNOWN
  kSunk = 5,       // of a single wheel: in some row it sank to its axle or no slip climbs the slope
  kChanged = 6,    // of a watch: something has changed
};

// Of a verdict: "go", "no_go", "unknown".
inline ExitStatus status_of(std::string_view verdict) {
  if (verdict == "go") return kDone;
  return verdict == "no_go" ? kNoGo : kUndecided;
}

}  // namespace slipway::server
