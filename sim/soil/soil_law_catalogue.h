#pragma once

#include <span>
#include <string_view>

#include "sim/soil/soil_law.h"

namespace slipway::sim {

// The laws that a soil file may name. The first row of each kind is what a soil has that names none.
struct SoilLawCatalogue {
  std::span<const PressureSinkageLaw* const> pressure;
  std::span<const ShearLaw* const> shear;
};

// The laws that ship, as explicit lists. Rows live as long as the program: soils point to them.
const SoilLawCatalogue& soil_law_catalogue();

// The rows by which a soil without a choice is computed.
extern const PressureSinkageLaw kBekkerPressure;
extern const ShearLaw kJanosiHanamotoShear;

// The row in force; Bekker's, Janosi and Hanamoto's where the soil chooses none.
const PressureSinkageLaw& row_of(const PressureLawChoice& choice);
const ShearLaw& row_of(const ShearLawChoice& choice);

}  // namespace slipway::sim
