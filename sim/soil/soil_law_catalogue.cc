#include "sim/soil/soil_law_catalogue.h"

#include <array>

#include "sim/soil/bekker_pressure.h"
#include "sim/soil/janosi_hanamoto.h"

namespace slipway::sim {
namespace {

constexpr std::array kPressureSinkage{
    PressureSinkageLaw{"bekker", "p = (k_c / b + k_phi) z^n", "[Bekker 1956]; ARTEMIS eq. 1",
                       &bekker_pressure_pa<double>},
};

constexpr std::array kShear{
    ShearLaw{"janosi_hanamoto", "tau = (c + sigma tan phi) (1 - exp(-j / K))",
             "[Janosi & Hanamoto 1961]; ARTEMIS eq. 3", &janosi_hanamoto_mobilised<double>},
};

}  // namespace

std::span<const PressureSinkageLaw> pressure_sinkage_catalogue() {
  return kPressureSinkage;
}
std::span<const ShearLaw> shear_catalogue() {
  return kShear;
}

}  // namespace slipway::sim
