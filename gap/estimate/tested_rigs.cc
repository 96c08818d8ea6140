#include "gap/estimate/tested_rigs.h"

#include <algorithm>
#include <cmath>

#include "sim/effects/effect_catalogue.h"

namespace slipway::gap {
namespace {

constexpr double kDecadesApart = 1000.0;  // ends of a range that is searched by logarithms
constexpr double kWideShare = 0.25;       // of its range, what a number differs by among soils of all kinds

bool has_effect(const sim::WheelRig& rig, std::string_view name) {
  const auto on = sim::in_force(rig.rover.effects, rig.effects);
  return std::any_of(on.begin(), on.end(), [&](const sim::EffectSetting& s) { return s.name == name; });
}

}  // namespace

TestedRigs::TestedRigs(const SoilData& data, std::span<const sim::SoilDistribution> soils, double width_m,
                       std::vector<FreeParameter> axes)
    : data_(data), width_m_(width_m), axes_(std::move(axes)) {
  for (const sim::SoilDistribution& soil : soils) starts_.push_back(soil.mean);
  for (std::size_t s = 0; s < starts_.size(); ++s) {
    std::vector<SoilParameter> own;
    std::vector<std::size_t> places;
    for (std::size_t k = 0; k < axes_.size(); ++k)
      if (axes_[k].soil && applies_to_soil(k, s)) {
        own.push_back(*axes_[k].soil);
        places.push_back(k);
      }
    of_soil_.emplace_back(starts_.front(), width_m, std::move(own));
    places_.push_back(std::move(places));
  }
  for (const FreeParameter& axis : axes_) further_.push_back(axis.soil ? Further{} : further_of(axis));
}

bool TestedRigs::applies_to_soil(std::size_t axis, std::size_t soil) const {
  const FreeParameter& parameter = axes_[axis];
  return parameter.is_of_soil() && (parameter.of.empty() || parameter.of == data_.soil_label(soil));
}

std::optional<std::size_t> TestedRigs::soil_of(std::size_t axis) const {
  for (std::size_t s = 0; s < starts_.size(); ++s)
    if (applies_to_soil(axis, s)) return s;
  return std::nullopt;
}

sim::WheelRig TestedRigs::rig_of(std::size_t rig) const {
  sim::WheelRig at = data_.rigs[rig].rig;
  at.soil = starts_[data_.rigs[rig].soil];
  return at;
}

TestedRigs::Further TestedRigs::further_of(const FreeParameter& axis) const {
  Further further;
  further.logarithm = axis.field.lowest > 0.0 && axis.field.highest >= kDecadesApart * axis.field.lowest;
  further.rigs.assign(data_.rigs.size(), false);
  const std::string_view effect =
      axis.is_of_effect() ? std::string_view(axis.name).substr(0, axis.name.find('.')) : std::string_view();
  // An effect that is on somewhere is free where it is on.
  const bool on_somewhere = axis.is_of_effect() && axis.of.empty() &&
                            std::any_of(data_.rigs.begin(), data_.rigs.end(),
                                        [&](const TestRig& r) { return has_effect(r.rig, effect); });
  bool started = false;
  for (std::size_t r = 0; r < data_.rigs.size(); ++r) {
    const TestRig& rig = data_.rigs[r];
    if (!axis.of.empty() && axis.of != rig.wheel && axis.of != data_.soil_label(rig.soil)) continue;
    if (on_somewhere && !has_effect(rig.rig, effect)) continue;
    further.rigs[r] = true;
    if (started) continue;
    further.start = sim::sweep_parameter_value(axis.swept, rig_of(r)).value_or(axis.field.initial);
    started = true;
  }
  return further;
}

sim::Soil TestedRigs::soil_at(std::size_t soil, std::span<const double> x) const {
  std::vector<double> own;
  for (const std::size_t place : places_[soil]) own.push_back(x[place]);
  sim::Soil at = of_soil_[soil].soil_at(own, starts_[soil]);
  sim::WheelRig rig;
  bool changed = false;
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    if (axes_[k].soil || !applies_to_soil(k, soil)) continue;
    if (!changed) rig.soil = at;
    changed = true;
    sim::set_sweep_parameter(axes_[k].swept, value_at(k, x), rig);
  }
  return changed ? rig.soil : at;
}

void TestedRigs::at(std::span<const double> x, std::vector<RigAt>& rigs) const {
  std::vector<sim::Soil> soils;
  for (std::size_t s = 0; s < starts_.size(); ++s) soils.push_back(soil_at(s, x));
  rigs.resize(data_.rigs.size());
  for (std::size_t r = 0; r < data_.rigs.size(); ++r) {
    sim::WheelRig rig = data_.rigs[r].rig;
    rig.soil = soils[data_.rigs[r].soil];
    for (std::size_t k = 0; k < axes_.size(); ++k)
      if (!axes_[k].is_of_soil() && further_[k].rigs[r])
        sim::set_sweep_parameter(axes_[k].swept, value_at(k, x), rig);
    sim::WheelRigConditions test = sim::conditions_of(rig);
    rigs[r] = {test.wheel, std::move(test.soil), std::move(test.drive)};
  }
}

double TestedRigs::value_at(std::size_t axis, std::span<const double> x) const {
  if (!axes_[axis].soil) return further_[axis].logarithm ? further_[axis].start * std::exp(x[axis]) : x[axis];
  return value_of(*axes_[axis].soil, soil_at(*soil_of(axis), x), width_m_);
}

double TestedRigs::start(std::size_t axis) const {
  if (!axes_[axis].soil) return further_[axis].logarithm ? 0.0 : further_[axis].start;
  const std::size_t soil = *soil_of(axis);
  return of_soil_[soil].coordinate(*axes_[axis].soil, starts_[soil]);
}

double TestedRigs::coordinate_of_value(std::size_t axis, double value) const {
  if (axes_[axis].soil) return of_soil_.front().coordinate_of_value(*axes_[axis].soil, value);
  return further_[axis].logarithm ? std::log(value / further_[axis].start) : value;
}

double TestedRigs::value_std(std::size_t axis, std::span<const double> x, double coordinate_std) const {
  if (axes_[axis].soil) {
    const std::size_t soil = *soil_of(axis);
    return of_soil_[soil].value_std(*axes_[axis].soil, soil_at(soil, x), coordinate_std);
  }
  return further_[axis].logarithm ? coordinate_std * value_at(axis, x) : coordinate_std;
}

double TestedRigs::scale(std::size_t axis) const {
  if (axes_[axis].soil) return of_soil_.front().scale(*axes_[axis].soil);
  return wide_std(axis);
}

double TestedRigs::wide_std(std::size_t axis) const {
  if (const auto parameter = axes_[axis].soil) {
    const bool modulus = *parameter == SoilParameter::kKc || *parameter == SoilParameter::kKphi;
    return row_of(*parameter).wide_std * (modulus ? of_soil_.front().scale(*parameter) : 1.0);
  }
  const Field& field = axes_[axis].field;
  return further_[axis].logarithm ? 1.0 : kWideShare * (field.highest - field.lowest);
}

double TestedRigs::lowest(std::size_t axis) const {
  const auto parameter = axes_[axis].soil;
  if (!parameter) return axes_[axis].field.lowest;
  const double lowest = row_of(*parameter).lowest;
  if (*parameter == SoilParameter::kBekker)
    return lowest * starts_[*soil_of(axis)].pressure.stiffness(width_m_);
  const bool modulus = *parameter == SoilParameter::kKc || *parameter == SoilParameter::kKphi;
  return modulus ? lowest * scale(axis) : lowest;
}

double TestedRigs::highest(std::size_t axis) const {
  const auto parameter = axes_[axis].soil;
  if (!parameter) return axes_[axis].field.highest;
  const double highest = row_of(*parameter).highest;
  if (*parameter == SoilParameter::kBekker)
    return highest * starts_[*soil_of(axis)].pressure.stiffness(width_m_);
  const bool modulus = *parameter == SoilParameter::kKc || *parameter == SoilParameter::kKphi;
  return modulus ? highest * scale(axis) : highest;
}

}  // namespace slipway::gap
