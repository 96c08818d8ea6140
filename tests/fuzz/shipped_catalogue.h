#pragma once

#include "api/files/catalogue.h"

namespace slipway::fuzz {

// The rovers, soils and terrains of data/, read once.
const api::Catalogue& shipped_catalogue();

}  // namespace slipway::fuzz
