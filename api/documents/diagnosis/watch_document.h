#pragma once

#include <string>

#include "gap/diagnosis/drive_watch.h"

namespace slipway::api::json {

// "watch/1": docs/reference/watch.md.
std::string watch_document(const gap::DriveWatch& watch);

}  // namespace slipway::api::json
