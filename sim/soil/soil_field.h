#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "core/model_field.h"
#include "sim/soil/soil.h"
#include "sim/soil/soil_law_catalogue.h"

namespace slipway::sim {

using SoilField = ModelField<Soil>;

// The numbers of a soil, in the order of its file. k_c and k_phi come first: they are those of Bekker's law,
// and stand in no soil that chooses another.
std::span<const SoilField> soil_fields();
bool is_bekker_modulus(const SoilField& field);

// What a soil's file may hold: its numbers, and the laws that it may choose. Readers, writers and sweeps take
// it as an argument, so that a test may add a row of its own.
struct SoilFormat {
  std::span<const SoilField> fields;
  SoilLawCatalogue laws;
};
const SoilFormat& soil_format();

// Nothing where the format has no such field.
const SoilField* find_soil_field(std::string_view name, const SoilFormat& format = soil_format());

}  // namespace slipway::sim
