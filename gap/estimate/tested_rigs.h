#pragma once

#include <optional>
#include <span>
#include <vector>

#include "gap/estimate/free_parameter.h"
#include "gap/estimate/soil_observation.h"
#include "gap/estimate/soil_parameter.h"

namespace slipway::gap {

// The soils of tests and what stands on the rigs, as functions of what is searched: one coordinate for each
// axis. The seven are searched as SoilAxes has them, all around the first soil; any other number by its
// logarithm where its range spans three decades or more, otherwise by itself, in the boundary's unit.
class TestedRigs {
 public:
  // `soils`: where the search starts, one for each of the data's. `axes`: k_phi only with k_bekker and
  // without k_c, every one once. The data must outlive it.
  TestedRigs(const SoilData& data, std::span<const sim::SoilDistribution> soils, double width_m,
             std::vector<FreeParameter> axes);

  std::span<const FreeParameter> axes() const { return axes_; }
  std::size_t soils() const { return starts_.size(); }
  // A soil without effects, and the rigs with theirs.
  sim::Soil soil_at(std::size_t soil, std::span<const double> x) const;
  void at(std::span<const double> x, std::vector<RigAt>& rigs) const;

  // Of an axis: its value at x, in SI and radians or, of what is none of the seven, in the boundary's unit;
  // where it starts; and the coordinate of a value.
  double value_at(std::size_t axis, std::span<const double> x) const;
  double start(std::size_t axis) const;  // a coordinate
  double coordinate_of_value(std::size_t axis, double value) const;
  // A standard deviation of the value from one of the coordinate, to first order at x.
  double value_std(std::size_t axis, std::span<const double> x, double coordinate_std) const;
  // A change of the coordinate that matters; one standard deviation of what soils of all kinds have.
  double scale(std::size_t axis) const;
  double wide_std(std::size_t axis) const;
  // Between which its value is searched.
  double lowest(std::size_t axis) const;
  double highest(std::size_t axis) const;

  // The first soil that has an axis; nothing where it is not a soil's.
  std::optional<std::size_t> soil_of(std::size_t axis) const;
  // The axes of SoilAxes that one soil has, and their places among all axes.
  const SoilAxes& soil_axes(std::size_t soil) const { return of_soil_[soil]; }
  std::span<const std::size_t> places(std::size_t soil) const { return places_[soil]; }
  bool applies_to_soil(std::size_t axis, std::size_t soil) const;

 private:
  struct Further {
    double start = 0.0;
    bool logarithm = false;
    std::vector<bool> rigs;  // on which it stands
  };
  Further further_of(const FreeParameter& axis) const;
  sim::WheelRig rig_of(std::size_t rig) const;

  const SoilData& data_;
  std::vector<sim::Soil> starts_;
  double width_m_;
  std::vector<FreeParameter> axes_;
  std::vector<SoilAxes> of_soil_;
  std::vector<std::vector<std::size_t>> places_;
  std::vector<Further> further_;  // of each axis; unused of the seven
};

}  // namespace slipway::gap
