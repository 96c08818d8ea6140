#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/json/writer.h"
#include "core/result.h"

namespace slipway::server {

// The areas of --keep-out or --keep-in, each "x,y x,y x,y" or the name of a GeoJSON file, as the request's
// member `key`; none where there are none. A file's polygons are in map metres, as those of an answer's
// routes. Errors: those of reading a file; invalid_request at /`key`/N for what is neither a list of places
// nor a file of polygons without holes.
Result<void> write_zone_options(api::json::Writer& w, std::string_view key,
                                const std::vector<std::string>& zones);

}  // namespace slipway::server
