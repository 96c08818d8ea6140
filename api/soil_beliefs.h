#pragma once

#include <vector>

#include "api/files/catalogue.h"
#include "api/requests/soil_regions.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::api {

// What is believed of a soil, `unmapped` being the belief about ground that no map names. With less than full
// confidence in the map's legend it may be any of the soils of unknown ground instead, another draw for each
// unit; the effects in force act on all of them, in their regions where the soil lies in some.
sim::SoilDistribution believed(const Catalogue& catalogue, const RegionalSoil& soil, double confidence,
                               std::string_view unmapped, const std::vector<sim::EffectSetting>& effects);

}  // namespace slipway::api
