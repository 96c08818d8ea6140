#include "sim/effects/digging.h"

#include <array>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"rim_share", "1", "greatest depth that the rim digs, over its radius, added to the soil's own", 0.0,
          1.0, 0.16, 0.0},
    Field{"rim_slip", "1", "slip travel i / (1 - i) at which half of it is dug", 0.01, 10.0, 0.65},
    Field{"cleat_share", "1", "depth that cleats dig per slip travel, over their height, added likewise", 0.0,
          3.0, 0.53, 0.0},
    Field{"cleat_limit", "1", "slip travel that cleats do not dig beyond", 0.1, 100.0, 4.8},
    Field{"sideways", "1", "what moving straight sideways adds to both, as a share", 0.0, 10.0, 1.6},
};

void change(std::span<const double> values, Soil& soil) {
  if (values[0] == 0.0 && values[2] == 0.0) return;
  soil.digging = {.rim_share = soil.digging.rim_share + values[0],
                  .rim_slip = values[1],
                  .cleat_share = soil.digging.cleat_share + values[2],
                  .cleat_limit = values[3],
                  .sideways = values[4]};
}

}  // namespace

// Drives of one place can't distinguish it from the parameters of their soil: it has no hypothesis, and no
// benchmark hides it.
constexpr Effect kDigging{.name = "digging",
                          .summary = "a slipping rim and its cleats carry soil out from under the wheel",
                          .reference = "[Reece 1965]; limits from [Pavlov & Johnson 2022]",
                          .fields = kFields,
                          .on_soil = &change,
                          .variants = &no_variants};

}  // namespace slipway::sim
