#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "core/field.h"

namespace slipway::sim {

struct Soil;

// The parameters that a law has of its own, in the order of its fields; SI and radians.
constexpr std::size_t kMaxLawParameters = 4;
using LawParameters = std::array<double, kMaxLawParameters>;

// The wheel or plate that presses on the soil, as far as a pressure-sinkage law may depend on it.
struct ContactSize {
  double width_m = 0.0;   // b, the smaller side of the contact
  double radius_m = 0.0;  // of the rim
};

// Pressure as a power of depth, which is the form that the wheel's kernel computes in packs:
//
//   p = stiffness (z per_depth)^n
//
// Bekker's law has per_depth = 1 / (1 m) and a stiffness in N/m^(n+2); a law of z / b has per_depth = 1 / b
// and a stiffness in Pa. n is Soil's exponent, to which slip sinkage adds.
struct PressureForm {
  double stiffness = 0.0;
  double per_depth_1_m = 1.0;
};

// One row: a law for the pressure under a wheel's rim. At a depth of 0 the pressure must be 0, and it must
// rise below. What reads the exponent n elsewhere (slip sinkage, the rebound of a rut) takes it as that of a
// power of depth.
struct PressureSinkageLaw {
  std::string_view name;
  std::string_view summary;
  std::string_view reference;
  // Parameters that stand in the soil file's "pressure_law" beside the name, each required there. Bekker's
  // own, k_c and k_phi, stand in the soil itself.
  std::span<const Field> fields;
  // The law's form on this soil under this contact. A law that is no power of depth gives one that comes near
  // it, from which the search for a wheel's sinkage starts.
  PressureForm (*form)(const Soil& soil, const ContactSize& contact);
  // For a law that is no power of depth: the numbers that it needs under this contact, once for each wheel,
  // and the pressure from them, for each node of the wheel's quadrature; both or neither. The kernel then
  // leaves its packs for every node, which costs about three times as much as Bekker's law.
  LawParameters (*numbers)(const Soil& soil, const ContactSize& contact) = nullptr;
  double (*pressure_pa)(const LawParameters& numbers, double n, double depth_m) = nullptr;
};

// Share of the shear strength that is mobilised, in the form that the wheel's kernel computes in packs:
//
//   m(x) = (1 - a) (end + hump exp(-x)) (1 - exp(-x)) + a x / (1 + x),    x = j / K,  a = hyperbola
//
// Janosi and Hanamoto's law has end = 1 and hump = 0.
struct ShearForm {
  double end;
  double hump;
  double hyperbola = 0.0;
};

// One row: a law for the share of the soil's shear strength that is mobilised at a displacement x of shear
// moduli. It must be 0 at 0, where its slope is positive, and stay above 0 and below 1.05.
struct ShearLaw {
  std::string_view name;
  std::string_view summary;
  std::string_view reference;
  std::span<const Field> fields;  // as those of a pressure-sinkage law, in the soil file's "shear_law"
  ShearForm (*form)(const LawParameters& parameters);
  // For a law that has not this form (`form` is not used then).
  double (*mobilised)(const LawParameters& parameters, double displacement_over_modulus) = nullptr;
};

// The law that a soil chooses, with its parameters. No row: Bekker's law, and Janosi and Hanamoto's.
struct PressureLawChoice {
  const PressureSinkageLaw* row = nullptr;
  LawParameters parameters{};
  double stiffening = 1.0;  // of all pressure: see Soil::stiffen
};
struct ShearLawChoice {
  const ShearLaw* row = nullptr;
  LawParameters parameters{};
};

}  // namespace slipway::sim
