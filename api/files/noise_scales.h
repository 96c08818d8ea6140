#pragma once

#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "gap/diagnosis/model/noise_model.h"

namespace slipway::api::json {

// What a campaign's drives scatter by, as an object: "noise" of a "diagnosis/1" and of a "corrected-model/1".
void write_noise_scales(Writer& w, const gap::NoiseScales& noise);
gap::NoiseScales read_noise_scales(ObjectReader reader);

}  // namespace slipway::api::json
