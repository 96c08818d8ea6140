#include "sim/soil/soil_field.h"

#include <algorithm>
#include <array>

namespace slipway::sim {
namespace {

constexpr auto kOptional = FieldPresence::kOptional;
constexpr auto kLessKnown = FieldPresence::kLessKnown;
constexpr auto kUnlessInitial = FieldWriting::kUnlessInitial;

constexpr std::array kFields{
    SoilField{.field = {"k_c", "N/m^(n+1)", "cohesive modulus", -1e10, 1e10, 0.0},
              .number = [](Soil& s) -> double& { return s.pressure.k_c; }},
    SoilField{.field = {"k_phi", "N/m^(n+2)", "frictional modulus", -1e10, 1e11, 1e6},
              .number = [](Soil& s) -> double& { return s.pressure.k_phi; }},
    SoilField{.field = {"n", "1", "exponent of sinkage", 0.01, 3.0, 1.0},
              .number = [](Soil& s) -> double& { return s.pressure.n; }},
    SoilField{.field = {"cohesion_pa", "Pa", "cohesion", 0.0, 1e6, 500.0},
              .number = [](Soil& s) -> double& { return s.cohesion_pa; }},
    SoilField{.field = {"friction_angle_deg", "deg", "angle of internal friction", 1e-3, 60.0, 30.0},
              .number = [](Soil& s) -> double& { return s.friction_angle_rad; },
              .kept_as = KeptAs::kRadians},
    SoilField{.field = {"shear_modulus_x_m", "m", "Janosi-Hanamoto's K, forward", 1e-6, 1.0, 0.01},
              .number = [](Soil& s) -> double& { return s.shear_modulus_x_m; }},
    SoilField{.field = {"shear_modulus_y_m", "m", "Janosi-Hanamoto's K, sideways", 1e-6, 1.0, 0.01},
              .number = [](Soil& s) -> double& { return s.shear_modulus_y_m; },
              .presence = kOptional},
    SoilField{.field = {"density_kg_m3", "kg/m^3", "bulk density", 100.0, 5000.0, 1500.0},
              .number = [](Soil& s) -> double& { return s.density_kg_m3; },
              .presence = kLessKnown},
    SoilField{.field = {"c1", "1", "of the angle of greatest normal stress, without slip", 0.0, 1.0, 0.4},
              .number = [](Soil& s) -> double& { return s.c1; },
              .presence = kLessKnown},
    SoilField{.field = {"c2", "1", "of the angle of greatest normal stress, per slip", -1.0, 1.0, 0.2},
              .number = [](Soil& s) -> double& { return s.c2; },
              .presence = kLessKnown},
    SoilField{.field = {"n1", "1", "slip sinkage: what slip adds to n", 0.0, 2.0, 0.0},
              .number = [](Soil& s) -> double& { return s.n1; },
              .presence = kOptional},
    SoilField{.field = {"n1_skid", "1", "slip sinkage: what skid adds to n besides", 0.0, 2.0, 0.0},
              .number = [](Soil& s) -> double& { return s.n1_skid; },
              .presence = kOptional},
    SoilField{.field = {"n1_lateral", "1", "slip sinkage: what sideways motion adds to n", 0.0, 2.0, 0.0},
              .number = [](Soil& s) -> double& { return s.n1_lateral; },
              .presence = kOptional},
    SoilField{.field = {"exit_angle_ratio", "1", "exit angle over entry angle", 0.0, 1.0, 0.0},
              .number = [](Soil& s) -> double& { return s.exit_angle_ratio; },
              .presence = kOptional},
    SoilField{.field = {"shear_coupling", "1", "0: shear along and across independent, 1: one resultant", 0.0,
                        1.0, 0.0},
              .number = [](Soil& s) -> double& { return s.shear_coupling; },
              .presence = kOptional},
    SoilField{.field = {"slip_directed_shear", "1",
                        "0: shear against the displacement, 1: against the rim's sliding", 0.0, 1.0, 0.0},
              .number = [](Soil& s) -> double& { return s.slip_directed; },
              .presence = kOptional,
              .writing = kUnlessInitial},
    SoilField{.field = {"inclined_softening", "1", "logarithm of what a locked wheel takes from the pressure",
                        0.0, 6.0, 0.0},
              .number = [](Soil& s) -> double& { return s.inclined_softening; },
              .presence = kOptional,
              .writing = kUnlessInitial},
    SoilField{.field = {"dig_rim_share", "1", "greatest depth that a slipping rim digs, over its radius", 0.0,
                        1.0, 0.0},
              .number = [](Soil& s) -> double& { return s.digging.rim_share; },
              .presence = kOptional,
              .writing = kUnlessInitial},
    SoilField{.field = {"dig_rim_slip", "1", "slip travel at which half of it is dug", 0.01, 10.0, 0.65},
              .number = [](Soil& s) -> double& { return s.digging.rim_slip; },
              .presence = kOptional,
              .writing = kUnlessInitial},
    SoilField{.field = {"dig_cleat_share", "1", "depth that cleats dig per slip travel, over their height",
                        0.0, 3.0, 0.0},
              .number = [](Soil& s) -> double& { return s.digging.cleat_share; },
              .presence = kOptional,
              .writing = kUnlessInitial},
    SoilField{.field = {"dig_cleat_limit", "1", "slip travel that cleats do not dig beyond", 0.1, 100.0, 4.8},
              .number = [](Soil& s) -> double& { return s.digging.cleat_limit; },
              .presence = kOptional,
              .writing = kUnlessInitial},
    SoilField{
        .field = {"dig_sideways", "1", "what moving straight sideways adds to what is dug", 0.0, 10.0, 0.0},
        .number = [](Soil& s) -> double& { return s.digging.sideways; },
        .presence = kOptional,
        .writing = kUnlessInitial},
    SoilField{
        .field = {"plough_front", "1", "factor of passive earth pressure before the front", 0.0, 60.0, 0.0},
        .number = [](Soil& s) -> double& { return s.ploughing.front; },
        .presence = kOptional,
        .writing = kUnlessInitial},
    SoilField{.field = {"plough_wall", "1", "factor of passive earth pressure before the side wall", 0.0,
                        60.0, 0.0},
              .number = [](Soil& s) -> double& { return s.ploughing.wall; },
              .presence = kOptional,
              .writing = kUnlessInitial},
    SoilField{.field = {"plough_heap", "1", "what the heap before a locked wheel adds", 0.0, 10.0, 0.0},
              .number = [](Soil& s) -> double& { return s.ploughing.heap; },
              .presence = kOptional,
              .writing = kUnlessInitial},
    SoilField{.field = {"plough_heap_slip", "1", "rim's way over the wheel's at which that is down to 1 / e",
                        0.01, 20.0, 1.8},
              .number = [](Soil& s) -> double& { return s.ploughing.heap_slip; },
              .presence = kOptional,
              .writing = kUnlessInitial},
    SoilField{
        .field = {"plough_wall_friction", "1", "coefficient of friction of soil on the wall", 0.0, 1.5, 0.0},
        .number = [](Soil& s) -> double& { return s.ploughing.wall_friction; },
        .presence = kOptional,
        .writing = kUnlessInitial},
    SoilField{.field = {"plough_wall_turn", "1", "speed of the wall along its plane over the rim's", 0.0, 1.0,
                        0.15},
              .number = [](Soil& s) -> double& { return s.ploughing.wall_turn; },
              .presence = kOptional,
              .writing = kUnlessInitial},
    SoilField{.field = {"plough_wall_yield", "1", "how far sideways speed turns the wall's friction away",
                        0.0, 10.0, 1.1},
              .number = [](Soil& s) -> double& { return s.ploughing.wall_yield; },
              .presence = kOptional,
              .writing = kUnlessInitial},
};

}  // namespace

std::span<const SoilField> soil_fields() {
  return kFields;
}

bool is_bekker_modulus(const SoilField& field) {
  return field.field.name == "k_c" || field.field.name == "k_phi";
}

const SoilFormat& soil_format() {
  static const SoilFormat format{kFields, soil_law_catalogue()};
  return format;
}

const SoilField* find_soil_field(std::string_view name, const SoilFormat& format) {
  const auto found = std::find_if(format.fields.begin(), format.fields.end(),
                                  [&](const SoilField& row) { return row.field.name == name; });
  return found == format.fields.end() ? nullptr : &*found;
}

}  // namespace slipway::sim
