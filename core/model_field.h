#pragma once

#include <optional>

#include "core/angle.h"
#include "core/field.h"

namespace slipway {

// What a number is kept in, where the boundary has the unit of its key.
enum class KeptAs {
  kSame,       // SI on both sides
  kRadians,    // degrees at the boundary, or degrees per second
  kPerRadian,  // per degree at the boundary
};

enum class FieldPresence {
  kRequired,
  kLessKnown,  // required in a file of its own, optional where a recorded campaign describes its model
  kOptional,   // its initial value stands where it is absent
};

enum class FieldWriting {
  kAlways,
  kUnlessInitial,  // left out where the file said nothing, or the same
};

// One number of a model's file: key, unit, range and member. Readers, writers, the check of a model, sweeps
// and estimation all take these from the one row. A row has one of the two members.
template <class Owner>
struct ModelField {
  Field field;  // unit and range at the boundary
  double& (*number)(Owner&) = nullptr;
  std::optional<double>& (*maybe)(Owner&) = nullptr;  // nothing where no source gives it; always optional
  FieldPresence presence = FieldPresence::kRequired;
  FieldWriting writing = FieldWriting::kAlways;
  KeptAs kept_as = KeptAs::kSame;

  bool holds(double boundary_value) const {
    return boundary_value >= field.lowest && boundary_value <= field.highest;
  }
  double from_boundary(double value) const {
    return kept_as == KeptAs::kRadians     ? rad_from_deg(value)
           : kept_as == KeptAs::kPerRadian ? value / rad_from_deg(1.0)
                                           : value;
  }
  double to_boundary(double value) const {
    return kept_as == KeptAs::kRadians     ? deg_from_rad(value)
           : kept_as == KeptAs::kPerRadian ? value * rad_from_deg(1.0)
                                           : value;
  }
};

}  // namespace slipway
