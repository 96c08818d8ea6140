#include "gap/diagnosis/model/window_variables.h"

#include <array>
#include <cstddef>

namespace slipway::gap {
namespace {

constexpr std::array<std::string_view, kWindowVariables> kNames{
    "slope_deg",     "cross_slope_deg", "slip",    "speed_m_s",
    "curvature_1_m", "temperature_c",   "turning", "time_s"};

}  // namespace

std::string_view name_of(WindowVariable variable) {
  return kNames[static_cast<std::size_t>(variable)];
}

double variable_of(const WindowVariables& of, WindowVariable variable) {
  const std::array<double, kWindowVariables> all{of.slope_deg, of.cross_slope_deg, of.slip,
                                                 of.speed_m_s, of.curvature_1_m,   of.temperature_c,
                                                 of.turning,   of.time_s};
  return all[static_cast<std::size_t>(variable)];
}

}  // namespace slipway::gap
