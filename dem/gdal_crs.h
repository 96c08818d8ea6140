#pragma once

#include <ogr_spatialref.h>

#include <memory>
#include <optional>
#include <string>

#include "core/result.h"
#include "dem/elevation_source.h"

namespace slipway::dem {

// A place in the raster's own CRS, around which a refusal suggests a projection.
struct RasterCentre {
  double x = 0.0;
  double y = 0.0;
};

// Checks that map coordinates are metres, x east and y north. The error has the reason, and the command that
// would convert `file` (a name without a folder).
Result<void> check_metric_projection(const OGRSpatialReference* crs, const RasterCentre& centre,
                                     const std::string& file);

// Checks that the middle of a projected map is a place of the body, and its scale one that a map can have. No
// command mends it: the true system must be stated.
Result<void> check_reach(const OGRSpatialReference& crs, const Extent& extent, const std::string& file);

// Checks that lengths on the map are those of the ground, within kMaxScaleError, at the corners, the middles
// of the edges and the centre of an extent. The error has the worst place and the command that would convert
// `file`.
constexpr double kMaxScaleError = 0.02;
Result<void> check_true_lengths(const OGRSpatialReference& crs, const Extent& extent,
                                const std::string& file);

// Whether places in this system can be brought into another one of the same body without a guess: false of no
// system, of one that is neither in degrees nor projected, and of a projected one with a west-positive axis.
bool can_be_reprojected(const OGRSpatialReference* crs);
// The projected system whose x is the negative of this one's, which counts towards the west; nothing where
// its central meridian is another than 0 or 180.
std::unique_ptr<OGRSpatialReference> eastward_projection(const OGRSpatialReference& crs);
// Whether x counts towards the west, by its axes or by its name.
bool is_west_positive(const OGRSpatialReference& crs);
// The system as PROJ writes it; empty where it can't.
std::string proj_words(const OGRSpatialReference& crs);
// A conformal system in metres around a place of the body in degrees, as PROJ writes it.
std::string conformal_projection(const OGRSpatialReference& crs, double longitude_deg, double latitude_deg);
// Longitude and latitude in degrees of a place in a projected system; nothing where it has none.
std::optional<RasterCentre> degrees_at(const OGRSpatialReference& crs, const RasterCentre& place);

// Whether a raster has no coordinate reference system, or a local one in metres.
bool is_local_frame(const OGRSpatialReference* crs);

// Name, WKT, body and semi-major axis of a CRS that passed the check.
void describe_crs(const OGRSpatialReference& crs, ElevationInfo& info);

// "gdalwarp -t_srs '...' -r bilinear in.tif in_m.tif", ready to be pasted into a shell.
std::string warp_command(const std::string& options, const std::string& file);

// The name of a command's output: "elevation_m.tif" for "elevation.img".
std::string converted_name(const std::string& file);

// A word for a POSIX shell: in single quotes unless it is plain.
std::string shell_word(const std::string& text);

}  // namespace slipway::dem
