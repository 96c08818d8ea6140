#include "sim/soil/reece_pressure.h"

#include "sim/soil/soil.h"

namespace slipway::sim {
namespace {

constexpr std::array kFields{
    Field{"k_c", "1", "cohesive modulus k_c' of Reece's law", -1e4, 1e6, 0.0},
    Field{"k_phi", "1", "frictional modulus k_phi' of Reece's law", -1e4, 1e6, 1000.0},
};

PressureForm form(const Soil& soil, const ContactSize& contact) {
  const LawParameters& p = soil.pressure_law.parameters;
  return {reece_stiffness_pa({.k_c = p[0], .k_phi = p[1]}, soil.cohesion_pa, soil.unit_weight_n_m3(),
                             contact.width_m),
          1.0 / contact.width_m};
}

}  // namespace

const PressureSinkageLaw kReecePressure{.name = "reece",
                                        .summary = "p = (c k_c' + gamma b k_phi') (z / b)^n",
                                        .reference = "[Reece 1965]; [Wong 2010] section 2.4",
                                        .fields = kFields,
                                        .form = &form};

}  // namespace slipway::sim
