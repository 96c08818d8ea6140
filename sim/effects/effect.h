#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/field.h"
#include "core/pose.h"
#include "sim/rover/rover_model.h"
#include "sim/soil/soil.h"

namespace slipway::sim {

// A round place on the map, frame M.
struct Disc {
  double x_m = 0.0, y_m = 0.0, radius_m = 0.0;

  bool holds(double x, double y) const {
    return (x - x_m) * (x - x_m) + (y - y_m) * (y - y_m) < radius_m * radius_m;
  }
};

// One way in which an effect could be at work on a rover: which of its fields the gap diagnosis estimates,
// with what prior, and what it holds the others at. Values are in the fields' units.
struct EffectVariant {
  struct Free {
    std::string field;
    double std = 1.0;                    // of the prior, around the neutral value
    double lowest = 0.0, highest = 0.0;  // bounds of the estimate
    // Where it is not the field's own: what this rover has already, or in this variant is believed first.
    std::optional<double> neutral = {};
    bool shape = false;  // it says in which form the effect is at work, not how strongly
  };
  std::string effect = {};  // the row's name; a row's own functions leave it empty
  std::string label = {};   // distinguishes the variants of one effect: "lf", "at 10 mm"; may be empty
  std::vector<Free> free = {};
  std::vector<std::pair<std::string, double>> fixed = {};
  // Fields that keep their initial value. All that is not free, fixed or in here is at its neutral value.
  std::vector<std::string> at_initial = {};
  // Of a row with `shown_tilt`: the share of the error that the inclinometer shows, and the share of it that
  // the rover really leans by.
  double shown = 0.0, acting = 1.0;
};

// What a benchmark asks an effect for: a size in multiples of the usual one, for this rover. Whatever has a
// side, a sign or a wheel draws it from `key`.
struct HiddenDraw {
  double size = 1.0;
  std::uint64_t key = 0;
  const RoverModel& rover;

  double sign(std::uint64_t counter) const;  // -1 or 1
  // In steps of a hundredth of the range.
  double between(double lowest, double highest, std::uint64_t counter) const;
};
using EffectParameters = std::map<std::string, double>;  // by the names of fields

// Roll and pitch that an inclinometer reports too much, rad.
struct TiltError {
  double roll_rad = 0.0, pitch_rad = 0.0;
};

// Something beyond the bare Bekker-Wong-Janosi wheel: a name, parameters with ranges, and all that the rest
// of the program needs to know of it. A file pair in sim/effects holds one row. Off, or with its neutral
// numbers, an effect changes nothing, which property tests check for every row. All functions are given one
// value per field, in the fields' order and units.
struct Effect {
  std::string_view name;
  std::string_view summary;    // one line for people
  std::string_view reference;  // who describes it, or where it was seen
  std::span<const Field> fields;

  // Physics: what it changes; null where it leaves rover or soil alone.
  void (*on_rover)(std::span<const double> values, RoverModel& rover) = nullptr;
  void (*on_soil)(std::span<const double> values, Soil& soil) = nullptr;
  // The optional number of a soil that stands for the same force by another equation; empty where none does.
  std::string_view twin = {};
  // The place in which on_soil is at work; null: everywhere.
  Disc (*region)(std::span<const double> values) = nullptr;
  // The field that holds the number of the wheel that it acts on (-1: all of them), "wheel" in answers of the
  // benchmark; empty where it acts on all.
  std::string_view wheel_field = {};
  // The field that holds the share of the commanded rate at which that wheel turns, which is measured where
  // wheels' rates are; empty where it changes no rate.
  std::string_view rate_field = {};
  // Whether the motors' temperatures change predictions through it, and through nothing else.
  bool reads_motor_temperature = false;

  // Hypothesis "this effect is missing" of the gap diagnosis: the ways in which it could be at work on this
  // rover. Null: one way, with every field free that has a neutral value, see variant_of_fields.
  std::vector<EffectVariant> (*variants)(const RoverModel& rover) = nullptr;
  // Of a row with a region: the variant at a place that residuals point to, with one free field, a share that
  // is 0 where the soil is as elsewhere. Such a row has no other variants.
  EffectVariant (*variant_at)(const Disc& place) = nullptr;
  // Of an effect that is, or may be, an error of the inclinometer; null: sensors do not show it.
  TiltError (*shown_tilt)(std::span<const double> values) = nullptr;
  // Whether other authors write it with other equations, so that what it does may differ in form from what is
  // written here. Effects of geometry have one form.
  bool has_many_forms = false;

  // What a benchmark of the diagnosis hides of it; fields that are not named keep their initial values. Null:
  // it is not hidden.
  EffectParameters (*hidden)(const HiddenDraw& draw) = nullptr;
};

// Of `variants`: for an effect that the drives of one place can't distinguish from soil parameters, or that
// is looked for in places (variant_at) instead.
std::vector<EffectVariant> no_variants(const RoverModel& rover);

// All fields with a neutral value free, each with a prior as wide as its initial value is far from that.
EffectVariant variant_of_fields(const Effect& effect);

// A field to estimate, bounded by its range in the catalogue. `fields` must hold `name`.
EffectVariant::Free free_field(std::span<const Field> fields, std::string_view name, double std);

}  // namespace slipway::sim
