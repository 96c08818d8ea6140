#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/field.h"
#include "gap/estimate/soil_parameter.h"

namespace slipway::gap {

// What is estimated: one of the seven parameters of soil_parameter.h, or any other number of a soil, of an
// effect or of a wheel that a single wheel on a rig has (sim::sweep_field).
struct FreeParameter {
  FreeParameter(SoilParameter parameter);  // NOLINT(google-explicit-constructor): one of the seven, of all

  std::string name;                   // "n", "c1", "smooth_rim.friction_share", "wheel.radius_m"
  std::string of;                     // the wheel or the soil whose it is; empty: it is shared by all
  std::optional<SoilParameter> soil;  // one of the seven; otherwise
  std::string swept;                  // its name for sim::set_sweep_parameter, and
  Field field;                        // unit and range there

  std::string shown() const { return of.empty() ? name : name + "@" + of; }
  std::string_view unit() const;
  // What one internal unit is at the boundary: 57.3 of an angle. Numbers that are none of the seven are kept
  // in the boundary's unit.
  double boundary_unit() const;
  bool is_of_soil() const;    // a number of the soil itself
  bool is_of_effect() const;  // a number of an effect
};
bool operator==(const FreeParameter& a, const FreeParameter& b);  // of name and of whose it is

// "n", "c1", "dig_rim_share", "smooth_rim.friction_share", "wheel.radius_m"; with "@LABEL" of one wheel or
// soil alone. A name may have "soil." or "effects." before it, as slipway wheel spells it. Nothing where
// there is no such number.
std::optional<FreeParameter> free_parameter(std::string_view text);
// All names that free_parameter knows, without prefixes.
std::vector<std::string> free_parameter_names();

}  // namespace slipway::gap
