#pragma once

#include <optional>
#include <vector>

#include "sim/prediction/drive_prediction.h"
#include "sim/soil/soil.h"

namespace slipway::sim {

// The soils of a drive in the order of Ground::soil_at's index, and the soil of unknown ground.
struct DriveSoils {
  std::vector<Soil> known;
  Soil unknown;

  const Soil& of(std::optional<std::size_t> soil) const { return soil ? known[*soil] : unknown; }
};

// The beliefs' mean soils.
DriveSoils mean_soils(const SoilBeliefs& beliefs);

}  // namespace slipway::sim
