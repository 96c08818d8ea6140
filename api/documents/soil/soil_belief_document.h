#pragma once

#include <filesystem>
#include <string>

#include "api/requests/soil_belief.h"
#include "core/result.h"

namespace slipway::api::json {

// Reads a file "soil-belief/1" and the tables of tests that it names, which lie under the data folder.
// Errors: unreadable_data with every fault of the file, or those of the first table that has any.
Result<SoilBeliefRequest> load_soil_belief_request(const std::filesystem::path& file,
                                                   const std::filesystem::path& data_folder);

// The answer of `slipway estimate belief`.
std::string soil_belief_document(const SoilBeliefRequest& request, const gap::SoilBelief& belief);

}  // namespace slipway::api::json
