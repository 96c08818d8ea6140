#include "sim/soil/hyperbolic_shear.h"

namespace slipway::sim {

const ShearLaw kHyperbolicShear{
    .name = "hyperbolic",
    .summary = "tau = (c + sigma tan phi) j / (K + j)",
    .reference = "[Kondner 1963]; [Duncan & Chang 1970]",
    .fields = {},
    .form = [](const LawParameters&) { return ShearForm{.end = 1.0, .hump = 0.0, .hyperbola = 1.0}; }};

}  // namespace slipway::sim
