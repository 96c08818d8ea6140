#pragma once

#include <string_view>
#include <vector>

#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "core/result.h"
#include "sim/soil/soil_field.h"

namespace slipway::api::json {

// Reads a file of soil distributions ("soils/1"): the keys of a drive campaign's soils as the mean, and their
// spread, source and assumptions beside them. All faults together.
//
// "pressure_law": {"name": "reece", ...} and "shear_law" choose a law of the format's catalogue, with the
// parameters of its row; without them a soil has Bekker's, and Janosi and Hanamoto's. k_c and k_phi are
// Bekker's alone. A soil with a "slip_curve" has none of the other parameters (sim/soil/slip_curve.h), and of
// its spread "slip_ratio" alone.
Result<std::vector<sim::SoilDistribution>> read_soil_file(std::string_view bytes,
                                                          const sim::SoilFormat& format = sim::soil_format());

// The list of soils under a key of another document: the same keys, soil by soil.
std::vector<sim::SoilDistribution> read_soils(ObjectReader& reader, std::string_view key, Presence presence,
                                              const sim::SoilFormat& format = sim::soil_format());

// The parameters of one soil of a drive campaign, without their spread. less_known: whether density_kg_m3, c1
// and c2 must be there; where not, sim::Soil's own stand. A campaign's soils have Bekker's law: another one
// is a fault.
void read_campaign_soil(ObjectReader& reader, Presence less_known, sim::Soil& soil);

// The same keys, so that what is served can be put into a file again.
void write_soil(Writer& w, const sim::SoilDistribution& soil,
                const sim::SoilFormat& format = sim::soil_format());

}  // namespace slipway::api::json
