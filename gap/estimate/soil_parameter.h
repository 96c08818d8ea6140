#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "gap/estimate/least_squares.h"
#include "sim/soil/soil_field.h"

namespace slipway::gap {

// What of a soil can be estimated: the six parameters of the ARTEMIS paper's section 3, or five with both
// moduli of sinkage as one, k_bekker = k_c / b + k_phi at the width b of the wheel or plate.
enum class SoilParameter { kBekker, kKc, kKphi, kN, kCohesion, kFrictionAngle, kShearModulus };
constexpr int kSoilParameters = 7;

struct SoilParameterRow {
  SoilParameter parameter;
  std::string_view name;  // "k_bekker", "friction_angle"
  std::string_view summary;
  std::string_view unit;       // at the boundary
  double boundary_unit = 1.0;  // what one internal unit is there: 57.3 of an angle
  // Its row in the table of a soil's file, from which unit and member are; none for k_bekker, which is two of
  // them.
  const sim::SoilField* field = nullptr;
  // Between which it is searched, inside what a file may hold: its value, in SI and radians; of a modulus of
  // sinkage in units of k_bekker (k_c: times b) where the search starts.
  double lowest = 0.0, highest = 0.0;
  // Of what is searched, its logarithm or tangent's logarithm, or itself (k_c in units of k b, cohesion in
  // Pa): one standard deviation of what soils of all kinds have.
  double wide_std = 1.0;
};

// In the order of the enumeration.
std::span<const SoilParameterRow> soil_parameter_rows();
const SoilParameterRow& row_of(SoilParameter parameter);
std::optional<SoilParameter> soil_parameter(std::string_view name);

// In SI and radians, k_bekker at the given width.
double value_of(SoilParameter parameter, const sim::Soil& soil, double width_m);

// A search's unknowns, all 0 at the base soil but k_c, k_phi and cohesion, which may be 0 or negative:
//
//   ln(k / k_0), k_c, ln(n / n_0), c, ln(tan phi / tan phi_0), ln(K / K_0)        k = k_c / b + k_phi
//
// k and k_c say both moduli; so do k and k_phi. With k alone both scale together.
class SoilAxes {
 public:
  // `axes`: k_phi only with k_bekker and without k_c; every one once.
  SoilAxes(const sim::Soil& base, double width_m, std::vector<SoilParameter> axes);

  std::span<const SoilParameter> axes() const { return axes_; }
  const sim::Soil& base() const { return base_; }
  double width_m() const { return width_m_; }
  // `onto`: a soil whose other numbers, and shares of the moduli, are kept; otherwise the base's.
  sim::Soil soil_at(std::span<const double> x) const { return soil_at(x, base_); }
  sim::Soil soil_at(std::span<const double> x, const sim::Soil& onto) const;
  double coordinate(SoilParameter axis, const sim::Soil& soil) const;
  // The coordinate at which the parameter has this value.
  double coordinate_of_value(SoilParameter axis, double value) const;
  // A standard deviation of the parameter from one of the coordinate, to first order at the soil.
  double value_std(SoilParameter axis, const sim::Soil& soil, double coordinate_std) const;
  // A change of the coordinate that matters: 1 of a logarithm, k b of k_c, 1 kPa of cohesion.
  double scale(SoilParameter axis) const;

 private:
  sim::Soil base_;
  double width_m_;
  std::vector<SoilParameter> axes_;
};

}  // namespace slipway::gap
