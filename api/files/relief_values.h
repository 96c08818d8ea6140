#pragma once

#include <optional>

#include "api/files/terrain_description.h"
#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "sim/prediction/relief_spread.h"

namespace slipway::api {

// The relief that a request's draws have on a terrain: the terrain's values, and over them those of the
// request, whose share of rocks holds everywhere where it has one. `classes` tells a place's class, of which
// the legend may give another share. Nothing where neither gives a deviation or a share.
std::shared_ptr<const sim::ReliefSpread> relief_spread(const ReliefValues& terrain,
                                                       const ReliefValues& request, const Legend& legend,
                                                       const std::shared_ptr<const dem::SoilMap>& classes);

namespace json {

// The object "relief", each of whose keys may be left out; nothing without it.
void read_relief(ObjectReader& reader, std::optional<ReliefValues>& relief);
void write_relief(Writer& w, const ReliefValues& relief);
void write_relief(Writer& w, const sim::ReliefSpread& relief);

// Of a share of rocks, wherever it stands.
inline constexpr NumberRule kRockShareRule{"1", 0.0, 0.6};

}  // namespace json
}  // namespace slipway::api
