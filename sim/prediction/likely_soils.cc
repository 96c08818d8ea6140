#include "sim/prediction/likely_soils.h"

#include <array>
#include <numeric>
#include <utility>

#include "core/random.h"

namespace slipway::sim {
namespace {

class LevelGround final : public Ground {
 public:
  std::optional<GroundPoint> at(double /*x_m*/, double /*y_m*/) const override { return GroundPoint{}; }
  std::optional<std::size_t> soil_at(double /*x_m*/, double /*y_m*/) const override { return std::nullopt; }
};

// The middles of `count` equal parts of (0, 1), in an order of their own for each key [Fisher & Yates].
std::vector<double> shuffled_middles(std::size_t count, std::uint64_t key) {
  std::vector<double> middles(count);
  for (std::size_t k = 0; k < count; ++k)
    middles[k] = (static_cast<double>(k) + 0.5) / static_cast<double>(count);
  for (std::size_t k = count; k > 1; --k) std::swap(middles[k - 1], middles[random_bits(key, k) % k]);
  return middles;
}

}  // namespace

LevelGroundTest::LevelGroundTest(const RoverModel& rover, double gravity_m_s2)
    : rover_(&rover), gravity_m_s2_(gravity_m_s2), level_(settle(rover, LevelGround(), {})) {}

bool LevelGroundTest::operator()(const Soil& soil) const {
  if (!level_) return true;
  QuasiStaticSolver solver(*rover_, gravity_m_s2_, Precision::kDraws);
  const StationState state = solver.solve(*level_, soil, {.speed_m_s = rover_->cruise_speed_m_s});
  return state.moving() && state.slip_ratio < kMaxLevelSlip;
}

std::vector<LikelySoil> likely_soils(const SoilDistribution& belief, std::size_t count,
                                     const DrawnGround::DrivesLevel& drives_level) {
  constexpr std::uint64_t kKey = 1979;  // any: the rows are as good under another
  constexpr std::size_t kStrength = kSoilDims, kPressure = kSoilDims + 1, kClosures = kSoilDims + 2;
  std::array<std::vector<double>, kClosures + kClosureDims> columns;
  for (std::size_t k = 0; k < columns.size(); ++k) columns[k] = shuffled_middles(count, random_key(kKey, k));
  std::vector<LikelySoil> soils;
  for (std::size_t row = 0; row < count; ++row) {
    SoilNormals z;
    for (int k = 0; k < kSoilDims; ++k) z[k] = normal_quantile(columns[static_cast<std::size_t>(k)][row]);
    const ClosureNormals closures(normal_quantile(columns[kClosures][row]),
                                  normal_quantile(columns[kClosures + 1][row]));
    if (belief.alternatives.empty()) {
      soils.push_back({draw_soil(belief, z, closures)});
      continue;
    }
    const SoilDistribution& strength =
        chosen_alternative(belief.alternatives, &SoilAlternative::strength_weight, columns[kStrength][row]);
    const SoilDistribution& pressure =
        belief.drawn_apart ? chosen_alternative(belief.alternatives, &SoilAlternative::pressure_weight,
                                                columns[kPressure][row])
                           : strength;
    const bool drawn_again = belief.drawn_apart && drives_level &&
                             !drives_level(joined_soil(strength, pressure, weak_unit(belief, z)));
    soils.push_back({joined_soil(strength, pressure, z, closures), drawn_again ? kWeakShare : 1.0});
  }
  return soils;
}

}  // namespace slipway::sim
