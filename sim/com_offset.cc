#include "sim/com_offset.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"forward_m", "m", "shift of the centre of mass forward", -0.5, 0.5, 0.0},
    Field{"left_m", "m", "shift of the centre of mass to the left", -0.5, 0.5, 0.0},
    Field{"up_m", "m", "shift of the centre of mass upward", -0.5, 0.5, 0.0},
};

void apply(std::span<const double> values, RoverModel& rover) {
  rover.com_m += Eigen::Vector3d(values[0], values[1], values[2]);
}

}  // namespace

constexpr Effect kComOffset{"com_offset",
                            "the centre of mass is not where the rover file has it",
                            "Zhurong section 4.1: random shifts of the centroid",
                            kFields,
                            &apply,
                            nullptr};

}  // namespace slipway::sim
