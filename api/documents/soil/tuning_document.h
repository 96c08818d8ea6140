#pragma once

#include <span>
#include <string>

#include "campaign/drive_table.h"
#include "campaign/tune.h"

namespace slipway::api::json {

// tuning.json, "tuning/1": parameters, every set that was tried with its score in each drive and in all, the
// best sets, the slopes that each serves, and the estimate by least squares.
std::string tuning_document(const campaign::DriveTable& table, const campaign::TuneRequest& request,
                            const campaign::TableTuning& result);

}  // namespace slipway::api::json
