#include "sim/dynamic/drive_soils.h"

namespace slipway::sim {

DriveSoils mean_soils(const SoilBeliefs& beliefs) {
  DriveSoils soils;
  for (const SoilDistribution& belief : beliefs.known) soils.known.push_back(belief.mean);
  soils.unknown = beliefs.unknown.mean;
  return soils;
}

}  // namespace slipway::sim
