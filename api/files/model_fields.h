#pragma once

#include <fmt/format.h>

#include <optional>
#include <span>
#include <string>

#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "core/model_field.h"

namespace slipway::api::json {

// Reads one number of a model by its row. `less_known`: whether what a file of its own must give has to be
// there.
template <class Owner>
bool read_field(ObjectReader& reader, const ModelField<Owner>& row, Presence less_known, Owner& object) {
  const NumberRule rule{row.field.unit, row.field.lowest, row.field.highest};
  const Presence presence = row.presence == FieldPresence::kRequired    ? kRequired
                            : row.presence == FieldPresence::kLessKnown ? less_known
                                                                        : kOptional;
  double value = 0.0;
  if (!reader.number(row.field.name, presence, rule, value)) return false;
  if (row.maybe != nullptr)
    row.maybe(object) = row.from_boundary(value);
  else
    row.number(object) = row.from_boundary(value);
  return true;
}

template <class Owner>
void read_fields(ObjectReader& reader, std::span<const ModelField<Owner>> rows, Presence less_known,
                 Owner& object) {
  for (const ModelField<Owner>& row : rows) read_field(reader, row, less_known, object);
}

// Writes one number so that it is read back as the same: exactly, or in degrees with the digits that were
// read.
template <class Owner>
void write_field(Writer& w, const ModelField<Owner>& row, const Owner& object) {
  Owner copy = object, initial{};
  const std::optional<double> value =
      row.maybe != nullptr ? row.maybe(copy) : std::optional(row.number(copy));
  if (!value) return;
  if (row.writing == FieldWriting::kUnlessInitial && row.number != nullptr && *value == row.number(initial))
    return;
  if (row.kept_as == KeptAs::kRadians) {
    w.angle_deg(row.field.name, *value);
  } else if (row.kept_as == KeptAs::kPerRadian) {
    w.exact(row.field.name, std::stod(fmt::format("{:.12g}", row.to_boundary(*value))));
  } else {
    w.exact(row.field.name, *value);
  }
}

template <class Owner>
void write_fields(Writer& w, std::span<const ModelField<Owner>> rows, const Owner& object) {
  for (const ModelField<Owner>& row : rows) write_field(w, row, object);
}

}  // namespace slipway::api::json
