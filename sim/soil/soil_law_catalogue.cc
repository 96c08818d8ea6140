#include "sim/soil/soil_law_catalogue.h"

#include <array>

#include "sim/soil/hyperbolic_shear.h"
#include "sim/soil/reece_pressure.h"
#include "sim/soil/soil.h"
#include "sim/soil/wong_shear.h"

namespace slipway::sim {
namespace {

constexpr std::array kPressure{&kBekkerPressure, &kReecePressure};
constexpr std::array kShear{&kJanosiHanamotoShear, &kWongShear, &kHyperbolicShear};

}  // namespace

const PressureSinkageLaw kBekkerPressure{.name = "bekker",
                                         .summary = "p = (k_c / b + k_phi) z^n",
                                         .reference = "[Bekker 1956]; [ARTEMIS] eq. 1",
                                         .fields = {},
                                         .form = [](const Soil& soil, const ContactSize& contact) {
                                           return PressureForm{soil.pressure.stiffness(contact.width_m), 1.0};
                                         }};

const ShearLaw kJanosiHanamotoShear{.name = "janosi_hanamoto",
                                    .summary = "tau = (c + sigma tan phi) (1 - exp(-j / K))",
                                    .reference = "[Janosi & Hanamoto 1961]; [ARTEMIS] eq. 3",
                                    .fields = {},
                                    .form = [](const LawParameters&) {
                                      return ShearForm{1.0, 0.0};
                                    }};

const SoilLawCatalogue& soil_law_catalogue() {
  static const SoilLawCatalogue catalogue{kPressure, kShear};
  return catalogue;
}

const PressureSinkageLaw& row_of(const PressureLawChoice& choice) {
  return choice.row == nullptr ? kBekkerPressure : *choice.row;
}

const ShearLaw& row_of(const ShearLawChoice& choice) {
  return choice.row == nullptr ? kJanosiHanamotoShear : *choice.row;
}

}  // namespace slipway::sim
