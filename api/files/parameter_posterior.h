#pragma once

#include <optional>

#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "gap/diagnosis/search/parameter_posterior.h"

namespace slipway::api::json {

// What drives leave open of a corrected model, "left_open" of a "corrected-model/1": parameters with their
// deviations, and the correlation of each with those before it.
void write_parameter_posterior(Writer& w, const gap::ParameterPosterior& posterior);
// Nothing where absent. Correlations that contradict each other are a fault.
std::optional<gap::ParameterPosterior> read_parameter_posterior(ObjectReader& model);

}  // namespace slipway::api::json
