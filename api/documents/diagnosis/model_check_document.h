#pragma once

#include <string>

#include "api/requests/model_check.h"

namespace slipway::api::json {

// "model-check/1": by channel and slope class, the errors of the nominal and of the corrected model, how far
// down they came, and the shares of values in the corrected prediction's intervals.
std::string model_check_document(const ModelCheckAnswer& answer);

}  // namespace slipway::api::json
