#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "api/requests/answers.h"
#include "api/requests/map_request.h"
#include "api/service.h"
#include "core/progress.h"

// Maps of the ground, and what is known of it at one place.
namespace slipway::api {

// As the requests of drives are read, see service_drives.h.
Result<MapRequest> read_map(const Service& service, std::string_view json);
// Errors: off_map, payload_too_large at /extent (0 cells: no limit).
Result<void> check_map_size(const Service& service, const MapRequest& request, long long max_cells);

// A map of the ground, written to the target. The same request gives the same bytes. Memory is bounded
// whatever its size, but of maps of ways (see kMaxServedMapCells). Errors: those of reading the terrain;
// payload_too_large above the target's limit; unwritable_file; cancelled.
Result<MapAnswer> run_map(const Service& service, const MapRequest& request, const MapTarget& target,
                          Progress& progress);
// The same map from pieces that may be made anywhere: squares of its tiles, which are read as one piece of
// ground in run_map() too, so that the bytes are the same. None of maps of ways, whose cells hang together.
// Errors: off_map, not_found.
Result<std::vector<MapPieceIndex>> map_pieces(const Service& service, const MapRequest& request);
// The tiles of a piece, row by row, as they are kept.
Result<std::vector<std::string>> map_piece(const Service& service, const MapRequest& request,
                                           const MapTarget& target, const MapPieceIndex& piece,
                                           Progress& progress);
// `tiles_of` gives those of the piece of that number.
Result<MapAnswer> map_of_pieces(const Service& service, const MapRequest& request, const MapTarget& target,
                                const std::function<Result<std::vector<std::string>>(int)>& tiles_of,
                                Progress& progress);

// Errors: not_found (unknown terrain), off_map, no_data.
Result<GroundAt> ground_at(const Service& service, std::string_view terrain, double x_m, double y_m);

}  // namespace slipway::api
