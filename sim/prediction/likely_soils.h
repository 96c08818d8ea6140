#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "sim/prediction/drawn_ground.h"
#include "sim/quasi_static/quasi_static.h"

namespace slipway::sim {

// Whether a rover drives level ground of a soil and slips by less than kMaxLevelSlip on it. The rover must
// outlive it; used from several threads.
class LevelGroundTest {
 public:
  LevelGroundTest(const RoverModel& rover, double gravity_m_s2);
  bool operator()(const Soil& soil) const;

 private:
  const RoverModel* rover_;
  double gravity_m_s2_;
  std::optional<Stance> level_;  // nothing where the rover has no stance: then it drives on all of them
};

struct LikelySoil {
  Soil soil;
  double weight = 1.0;
};

// The soils that one place may have, by what DrawnGround draws there: a Latin hypercube [McKay, Beckman &
// Conover 1979] of `count` rows over the alternatives of strength and pressure and all normal numbers, so
// that an alternative with a probability of 15 % has 15 % of the rows, to one row. A row that DrawnGround
// would draw again weighs kWeakShare of the others. The same belief gives the same soils.
std::vector<LikelySoil> likely_soils(const SoilDistribution& belief, std::size_t count,
                                     const DrawnGround::DrivesLevel& drives_level);

}  // namespace slipway::sim
