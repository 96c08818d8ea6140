#include "gap/estimate/soil_parameter.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"

namespace slipway::gap {
namespace {

constexpr double kCohesionScale_pa = 1000.0;
constexpr double kMaxStiffer = 1000.0;  // than the soil that a search starts from, or softer

// What the table of a soil's fields does not say of a parameter.
struct Searched {
  SoilParameter parameter;
  std::string_view name, summary;
  std::string_view key;  // of the soil's file
  double lowest, highest, wide_std;
};

constexpr std::array<Searched, kSoilParameters> kSearched{{
    {SoilParameter::kBekker, "k_bekker", "both moduli of sinkage as one, k_c / b + k_phi", "",
     1.0 / kMaxStiffer, kMaxStiffer, 2.0},
    {SoilParameter::kKc, "k_c", "cohesive modulus of sinkage; may be negative", "k_c", -20.0, 20.0, 1.0},
    {SoilParameter::kKphi, "k_phi", "frictional modulus of sinkage", "k_phi", -20.0, 20.0, 1.0},
    {SoilParameter::kN, "n", "exponent of sinkage", "n", 0.1, 3.0, 0.5},
    {SoilParameter::kCohesion, "cohesion", "cohesion", "cohesion_pa", 0.0, 50e3, 1000.0},
    {SoilParameter::kFrictionAngle, "friction_angle", "angle of internal friction", "friction_angle_deg",
     rad_from_deg(1.0), rad_from_deg(59.0), 0.5},
    {SoilParameter::kShearModulus, "shear_modulus", "Janosi's modulus of shear K", "shear_modulus_x_m", 1e-4,
     0.5, 1.0},
}};

std::array<SoilParameterRow, kSoilParameters> make_rows() {
  std::array<SoilParameterRow, kSoilParameters> rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Searched& s = kSearched[i];
    const sim::SoilField* field = sim::find_soil_field(s.key);
    rows[i] = {.parameter = s.parameter,
               .name = s.name,
               .summary = s.summary,
               .unit = field ? field->field.unit : sim::find_soil_field("k_phi")->field.unit,
               .boundary_unit = field ? field->to_boundary(1.0) : 1.0,
               .field = field,
               .lowest = s.lowest,
               .highest = s.highest,
               .wide_std = s.wide_std};
  }
  return rows;
}

const std::array<SoilParameterRow, kSoilParameters>& rows() {
  static const auto all = make_rows();
  return all;
}

}  // namespace

std::span<const SoilParameterRow> soil_parameter_rows() {
  return rows();
}

const SoilParameterRow& row_of(SoilParameter parameter) {
  return rows()[static_cast<std::size_t>(parameter)];
}

std::optional<SoilParameter> soil_parameter(std::string_view name) {
  for (const SoilParameterRow& row : rows())
    if (row.name == name) return row.parameter;
  return std::nullopt;
}

double value_of(SoilParameter parameter, const sim::Soil& soil, double width_m) {
  const sim::SoilField* field = row_of(parameter).field;
  if (field == nullptr) return soil.pressure.stiffness(width_m);
  sim::Soil copy = soil;
  return field->number(copy);
}

SoilAxes::SoilAxes(const sim::Soil& base, double width_m, std::vector<SoilParameter> axes)
    : base_(base), width_m_(width_m), axes_(std::move(axes)) {}

sim::Soil SoilAxes::soil_at(std::span<const double> x, const sim::Soil& onto) const {
  sim::Soil soil = onto;
  const double own_stiffness = onto.pressure.stiffness(width_m_);
  double stiffness = own_stiffness;
  std::optional<double> k_c, k_phi;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    switch (axes_[i]) {
      case SoilParameter::kBekker:
        stiffness = base_.pressure.stiffness(width_m_) * std::exp(x[i]);
        break;
      case SoilParameter::kKc:
        k_c = x[i];
        break;
      case SoilParameter::kKphi:
        k_phi = x[i];
        break;
      case SoilParameter::kN:
        soil.pressure.n = base_.pressure.n * std::exp(x[i]);
        break;
      case SoilParameter::kCohesion:
        soil.cohesion_pa = x[i];
        break;
      case SoilParameter::kFrictionAngle:
        soil.friction_angle_rad = std::atan(std::tan(base_.friction_angle_rad) * std::exp(x[i]));
        break;
      case SoilParameter::kShearModulus:
        soil.shear_modulus_x_m = base_.shear_modulus_x_m * std::exp(x[i]);
        // Both scale together.
        soil.shear_modulus_y_m = soil.shear_modulus_x_m * (onto.shear_modulus_y_m / onto.shear_modulus_x_m);
        break;
    }
  }
  if (k_phi) k_c = (stiffness - *k_phi) * width_m_;
  soil.pressure.k_c = k_c.value_or(onto.pressure.k_c * (stiffness / own_stiffness));
  soil.pressure.k_phi =
      k_c ? stiffness - soil.pressure.k_c / width_m_ : onto.pressure.k_phi * (stiffness / own_stiffness);
  return soil;
}

double SoilAxes::coordinate(SoilParameter axis, const sim::Soil& soil) const {
  return coordinate_of_value(axis, value_of(axis, soil, width_m_));
}

double SoilAxes::coordinate_of_value(SoilParameter axis, double value) const {
  switch (axis) {
    case SoilParameter::kKc:
    case SoilParameter::kKphi:
    case SoilParameter::kCohesion:
      return value;
    case SoilParameter::kFrictionAngle:
      return std::log(std::tan(value) / std::tan(base_.friction_angle_rad));
    default:
      return std::log(value / value_of(axis, base_, width_m_));
  }
}

double SoilAxes::value_std(SoilParameter axis, const sim::Soil& soil, double coordinate_std) const {
  switch (axis) {
    case SoilParameter::kKc:
    case SoilParameter::kKphi:
    case SoilParameter::kCohesion:
      return coordinate_std;
    case SoilParameter::kFrictionAngle:
      return coordinate_std * std::sin(soil.friction_angle_rad) * std::cos(soil.friction_angle_rad);
    default:
      return coordinate_std * value_of(axis, soil, width_m_);
  }
}

double SoilAxes::scale(SoilParameter axis) const {
  const double stiffness = base_.pressure.stiffness(width_m_);
  if (axis == SoilParameter::kKc) return stiffness * width_m_;
  if (axis == SoilParameter::kKphi) return stiffness;
  return axis == SoilParameter::kCohesion ? kCohesionScale_pa : 1.0;
}

}  // namespace slipway::gap
