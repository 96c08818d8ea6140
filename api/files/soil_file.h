#pragma once

#include <string_view>
#include <vector>

#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "core/result.h"
#include "sim/soil/soil.h"

namespace slipway::api::json {

// Reads a file of soil distributions ("soils/1"): the keys of a drive campaign's soils as the mean, and their
// spread, source and assumptions beside them. All faults together.
Result<std::vector<sim::SoilDistribution>> read_soil_file(std::string_view bytes);

// The list of soils under a key of another document: the same keys, soil by soil.
std::vector<sim::SoilDistribution> read_soils(ObjectReader& reader, std::string_view key, Presence presence);

// The parameters of one soil, without their spread. less_known: whether density_kg_m3, c1 and c2 must be
// there; where not, sim::Soil's own stand.
void read_soil_parameters(ObjectReader& reader, Presence less_known, sim::Soil& soil);

// The same keys, so that what is served can be put into a file again.
void write_soil(Writer& w, const sim::SoilDistribution& soil);

}  // namespace slipway::api::json
