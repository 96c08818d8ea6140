#pragma once

#include <vector>

#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "planner/problem/problem.h"

namespace slipway::api::json {

// "keep_out" and "keep_in": lists of rings of corners [x_m, y_m], which may be closed as GeoJSON closes them.
void read_zones(ObjectReader& reader, std::vector<planner::Polygon>& keep_out,
                std::vector<planner::Polygon>& keep_in, std::vector<Fault>& faults);
// The first always, the second where there is one.
void write_zones(Writer& w, const std::vector<planner::Polygon>& keep_out,
                 const std::vector<planner::Polygon>& keep_in);

}  // namespace slipway::api::json
