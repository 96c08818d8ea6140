#include "sim/soil/wong_shear.h"

#include <numbers>

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"residual_ratio", "1", "residual shear stress over the greatest, K_r", 0.3, 0.9, 0.7},
};

}  // namespace

ShearForm wong_shear_form(double residual_ratio) {
  constexpr double e = std::numbers::e;
  return {residual_ratio, e * (1.0 / (1.0 - 1.0 / e) - residual_ratio)};
}

const ShearLaw kWongShear{.name = "wong",
                          .summary = "rises to a hump at j = K and falls to a residual",
                          .reference = "[Wong & Preston-Thomas 1983]; [Wong 2010] section 2.4",
                          .fields = kFields,
                          .form = [](const LawParameters& p) { return wong_shear_form(p[0]); }};

}  // namespace slipway::sim
