#include "dem/gdal_crs.h"

#include <cpl_conv.h>
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "core/angle.h"
#include "dem/gdal_crs_parts.h"

namespace slipway::dem {
namespace {

struct CplFree {
  void operator()(char* text) const { CPLFree(text); }
};
using CplText = std::unique_ptr<char, CplFree>;

// The axes of an ellipsoid as PROJ writes them: "+R=3396190" or "+a=... +b=...". The datum's own numbers,
// never a datum's name: PROJ has no names for other worlds.
std::string proj_ellipsoid(const OGRSpatialReference& crs) {
  const double a = crs.GetSemiMajor();
  const double b = crs.GetSemiMinor();
  return a == b ? fmt::format("+R={}", a) : fmt::format("+a={} +b={}", a, b);
}

// A projection around a place in degrees. On a sphere the equidistant cylindrical one that planetary maps
// use; on an ellipsoid transverse Mercator, because PROJ has equidistant cylindrical in its spherical form
// only.
std::string local_projection(const OGRSpatialReference& crs, double longitude_deg, double latitude_deg) {
  const double lon = std::round(longitude_deg * 1e4) / 1e4;
  const double lat = std::round(latitude_deg * 1e4) / 1e4;
  const std::string ellipsoid = proj_ellipsoid(crs);
  if (crs.GetSemiMajor() == crs.GetSemiMinor()) {
    return fmt::format("+proj=eqc +lat_ts={} +lat_0=0 +lon_0={} {} +units=m +no_defs", lat, lon, ellipsoid);
  }
  return fmt::format("+proj=tmerc +lat_0={} +lon_0={} +k=1 +x_0=0 +y_0=0 {} +units=m +no_defs", lat, lon,
                     ellipsoid);
}

// How many metres of the ground a metre of the map is: the least and the most over all directions.
struct LocalScale {
  double least = 1.0, most = 1.0;
  double error() const { return std::max(1.0 - least, most - 1.0); }
};

// The scale of a projected system from place to place. Nothing where the projection does not reach.
class GroundScale {
 public:
  explicit GroundScale(const OGRSpatialReference& crs) : map_(crs), degrees_(crs.CloneGeogCS()) {
    map_.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (!degrees_) return;
    degrees_->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    to_degrees_.reset(OGRCreateCoordinateTransformation(&map_, degrees_.get()));
  }

  // Longitude and latitude.
  std::optional<RasterCentre> degrees_of(RasterCentre at) const {
    if (!to_degrees_ || to_degrees_->Transform(1, &at.x, &at.y) == FALSE) return std::nullopt;
    return at;
  }

  std::optional<LocalScale> at(const RasterCentre& place) const {
    constexpr double kStep_m = 50.0;
    const auto west = on_body({place.x - kStep_m, place.y}), east = on_body({place.x + kStep_m, place.y});
    const auto south = on_body({place.x, place.y - kStep_m}), north = on_body({place.x, place.y + kStep_m});
    if (!west || !east || !south || !north) return std::nullopt;
    const Eigen::Vector3d by_x = (*east - *west) / (2.0 * kStep_m),
                          by_y = (*north - *south) / (2.0 * kStep_m);
    // The singular values of the two columns.
    const double xx = by_x.squaredNorm(), yy = by_y.squaredNorm(), xy = by_x.dot(by_y);
    const double root = std::hypot(0.5 * (xx - yy), xy), mean = 0.5 * (xx + yy);
    if (!std::isfinite(mean)) return std::nullopt;
    return LocalScale{std::sqrt(std::max(0.0, mean - root)), std::sqrt(mean + root)};
  }

 private:
  // In the body's own Cartesian axes, so that the poles are places like any other.
  std::optional<Eigen::Vector3d> on_body(const RasterCentre& place) const {
    const auto degrees = degrees_of(place);
    if (!degrees) return std::nullopt;
    const double a = map_.GetSemiMajor(), b = map_.GetSemiMinor(), e2 = 1.0 - b * b / (a * a);
    const double lon = rad_from_deg(degrees->x), lat = rad_from_deg(degrees->y);
    const double s = std::sin(lat), c = std::cos(lat), n = a / std::sqrt(1.0 - e2 * s * s);
    return Eigen::Vector3d(n * c * std::cos(lon), n * c * std::sin(lon), n * (1.0 - e2) * s);
  }

  OGRSpatialReference map_;
  std::unique_ptr<OGRSpatialReference> degrees_;
  std::unique_ptr<OGRCoordinateTransformation> to_degrees_;
};

tl::unexpected<Error> refuse(const std::string& reason, const std::string& remedy) {
  const std::string sentence = fmt::format("{} Convert it with: {}", reason, remedy);
  return fail(ErrorCode::kUnsupportedCrs, sentence, {{"", sentence}});
}

// GeoTIFF forgets that a planetographic CRS counts longitude towards the west, but keeps its name.
bool named_planetographic(const OGRSpatialReference& crs) {
  for (const char* node : {"PROJCS", "GEOGCS"}) {
    const char* name = crs.GetAttrValue(node);
    if (name != nullptr && std::string_view(name).find("Ographic") != std::string_view::npos) return true;
  }
  return false;
}

// Axes to the south are let through: polar projections name their axes after meridians, and x and y of the
// raster are right all the same.
bool has_west_axis(const OGRSpatialReference& crs) {
  for (const char* node : {"PROJCS", "GEOGCS"}) {
    for (int axis = 0; axis < 2; ++axis) {
      OGRAxisOrientation orientation = OAO_Other;
      if (crs.GetAxis(node, axis, &orientation) != nullptr && orientation == OAO_West) return true;
    }
  }
  return false;
}

// The same projection counted east and north, which is PROJ's own order.
std::string without_axes(std::string proj) {
  const std::size_t first = proj.find(" +axis=");
  if (first != std::string::npos) proj.erase(first, proj.find(' ', first + 1) - first);
  return proj;
}

tl::unexpected<Error> refuse_west_positive(const OGRSpatialReference& crs, const RasterCentre& centre,
                                           const std::string& file) {
  const std::string east_positive =
      crs.IsGeographic() ? local_projection(crs, -centre.x, centre.y) : without_axes(proj_words(crs));
  return refuse(
      fmt::format(
          "{} is in \"{}\", a system with a west-positive axis (planetographic on most worlds), which "
          "mirrors the map without a warning.",
          file, crs.GetName()),
      fmt::format(
          "{} (where its x in truth grows towards the east, correct the label instead: gdal_translate "
          "-a_srs {} {} {})",
          warp_command(fmt::format("-t_srs {}", shell_word(east_positive)), file), shell_word(east_positive),
          shell_word(file), shell_word(converted_name(file))));
}

// What a system without a place most likely is, by its name: GeoTIFF has no form for latitudes that are
// counted at the centre of an ellipsoid, and keeps them as a local frame.
std::string likely_system(const OGRSpatialReference& crs) {
  const std::string_view name = crs.GetName();
  if (name.find("Ocentric") == std::string_view::npos) return "It may be a local frame of a site.";
  const char* const sphere = name.find("Mars") != std::string_view::npos   ? "3396190"
                             : name.find("Moon") != std::string_view::npos ? "1737400"
                                                                           : "RADIUS";
  return fmt::format(
      "Its name is that of planetocentric degrees, of which the file has kept no more: --crs '+proj=longlat "
      "+R={} +no_defs' takes them as degrees on the sphere, where they keep their places.",
      sphere);
}

std::string metre_version(const OGRSpatialReference& crs) {
  OGRSpatialReference metres(crs);
  metres.SetLinearUnitsAndUpdateParameters(SRS_UL_METER, 1.0);
  return proj_words(metres);
}

}  // namespace

std::string proj_words(const OGRSpatialReference& crs) {
  char* text = nullptr;
  const OGRErr failed = crs.exportToProj4(&text);
  const CplText owned(text);
  if (failed != OGRERR_NONE || text == nullptr) return {};
  std::string answer(text);
  while (!answer.empty() && answer.back() == ' ') answer.pop_back();
  return answer;
}

std::string conformal_projection(const OGRSpatialReference& crs, double longitude_deg, double latitude_deg) {
  return fmt::format("+proj=stere +lat_0={} +lon_0={} +k=1 +x_0=0 +y_0=0 {} +units=m +no_defs",
                     std::round(latitude_deg * 1e4) / 1e4, std::round(longitude_deg * 1e4) / 1e4,
                     proj_ellipsoid(crs));
}

bool is_west_positive(const OGRSpatialReference& crs) {
  return has_west_axis(crs) || named_planetographic(crs);
}

bool can_be_reprojected(const OGRSpatialReference* crs) {
  if (crs == nullptr || crs->IsEmpty()) return false;
  return crs->IsGeographic() != 0 ||
         (crs->IsProjected() != 0 && (!is_west_positive(*crs) || eastward_projection(*crs) != nullptr));
}

std::unique_ptr<OGRSpatialReference> eastward_projection(const OGRSpatialReference& crs) {
  // Whether its central meridian counts to the west too, nobody says; of these it does not matter.
  const double meridian = std::abs(crs.GetProjParm(SRS_PP_CENTRAL_MERIDIAN, 0.0));
  if (meridian != 0.0 && meridian != 180.0) return nullptr;
  char* text = nullptr;
  if (crs.exportToProj4(&text) != OGRERR_NONE) return nullptr;
  const std::string words = text;
  CPLFree(text);
  if (words.find("+axis=ws") != std::string::npos) return nullptr;  // y counts to the south as well
  auto east = std::make_unique<OGRSpatialReference>();
  if (east->importFromProj4(without_axes(words).c_str()) != OGRERR_NONE || east->IsProjected() == 0)
    return nullptr;
  east->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return east;
}

std::optional<RasterCentre> degrees_at(const OGRSpatialReference& crs, const RasterCentre& place) {
  return GroundScale(crs).degrees_of(place);
}

std::string shell_word(const std::string& text) {
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
  if (!text.empty() && text.front() != '-' && text.find_first_not_of(kPlain) == std::string::npos)
    return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string converted_name(const std::string& file) {
  return std::filesystem::path(file).stem().string() + "_m.tif";
}

std::string warp_command(const std::string& options, const std::string& file) {
  return fmt::format("gdalwarp {}{}-r bilinear {} {}", options, options.empty() ? "" : " ", shell_word(file),
                     shell_word(converted_name(file)));
}

Result<void> check_metric_projection(const OGRSpatialReference* crs, const RasterCentre& centre,
                                     const std::string& file) {
  if (crs == nullptr || crs->IsEmpty()) {
    return refuse(
        fmt::format("{} has no coordinate reference system.", file),
        fmt::format(
            "gdal_translate -a_srs '+proj=eqc +lat_ts=0 +lon_0=0 +R=3396190 +units=m +no_defs' {} {}, "
            "with the projection it was made in (this one is an example, on the Mars sphere)",
            shell_word(file), shell_word(converted_name(file))));
  }
  if (is_west_positive(*crs)) return refuse_west_positive(*crs, centre, file);
  if (crs->IsGeographic()) {
    return refuse(
        fmt::format("{} has pixels in degrees (\"{}\"); slopes need metres.", file, crs->GetName()),
        warp_command(fmt::format("-t_srs {}", shell_word(local_projection(*crs, centre.x, centre.y))), file));
  }
  if (!crs->IsProjected()) {
    const std::string sentence = fmt::format(
        "{} is in \"{}\", which says neither a projection nor degrees. State the system that it was made in, "
        "in the file or with --crs. {}",
        file, crs->GetName(), likely_system(*crs));
    return fail(ErrorCode::kUnsupportedCrs, sentence, {{"", sentence}});
  }
  const char* unit = nullptr;
  const double metres_per_unit = crs->GetLinearUnits(&unit);
  if (std::abs(metres_per_unit - 1.0) > 1e-9) {
    return refuse(fmt::format("{} is in \"{}\", whose unit is {} ({} m), not the metre.", file,
                              crs->GetName(), unit == nullptr ? "unknown" : unit, metres_per_unit),
                  warp_command(fmt::format("-t_srs {}", shell_word(metre_version(*crs))), file));
  }
  return {};
}

Result<void> check_reach(const OGRSpatialReference& crs, const Extent& extent, const std::string& file) {
  if (crs.IsProjected() == 0) return {};
  if (const auto fault = fault_of_scale(crs, file))
    return fail(ErrorCode::kUnsupportedCrs, *fault, {{"", *fault}});
  const RasterCentre centre{0.5 * (extent.west_m + extent.east_m), 0.5 * (extent.south_m + extent.north_m)};
  // Metres of the ground that a metre of the map may be: Mercator has the least at 89.7 degrees.
  constexpr double kNone = 1e-6, kLeast = 0.005, kMost = 100.0;
  const auto scale = GroundScale(crs).at(centre);
  if (scale && scale->least > kNone && scale->most >= kLeast && scale->most <= kMost) return {};
  const std::string sentence = fmt::format(
      "{} is in \"{}\", in which the middle of the map, ({:.0f}, {:.0f}), is no place of the body: it has no "
      "longitude and latitude. State the system that the map was made in, in the file or with --crs.",
      file, crs.GetName(), centre.x, centre.y);
  return fail(ErrorCode::kUnsupportedCrs, sentence, {{"", sentence}});
}

Result<void> check_true_lengths(const OGRSpatialReference& crs, const Extent& extent,
                                const std::string& file) {
  if (const auto reach = check_reach(crs, extent, file); !reach) return reach;
  const GroundScale scales(crs);
  const RasterCentre centre{0.5 * (extent.west_m + extent.east_m), 0.5 * (extent.south_m + extent.north_m)};
  LocalScale worst;
  RasterCentre place;
  for (const double x : {extent.west_m, centre.x, extent.east_m}) {
    for (const double y : {extent.south_m, centre.y, extent.north_m}) {
      const auto scale = scales.at({x, y});
      if (!scale || scale->error() <= worst.error()) continue;
      worst = *scale;
      place = {x, y};
    }
  }
  if (worst.error() <= kMaxScaleError) return {};
  const RasterCentre degrees = scales.degrees_of(centre).value_or(RasterCentre{});
  return refuse(
      fmt::format(
          "{} is in \"{}\", in which a metre of the map is {:.3f} to {:.3f} m of the ground at ({:.0f}, "
          "{:.0f}): slopes and lengths would be wrong.",
          file, crs.GetName(), worst.least, worst.most, place.x, place.y),
      warp_command(fmt::format("-t_srs {}", shell_word(conformal_projection(crs, degrees.x, degrees.y))),
                   file));
}

bool is_local_frame(const OGRSpatialReference* crs) {
  if (crs == nullptr || crs->IsEmpty()) return true;
  return crs->IsLocal() != 0 && std::abs(crs->GetLinearUnits() - 1.0) < 1e-9;
}

void describe_crs(const OGRSpatialReference& crs, ElevationInfo& info) {
  const char* name = crs.GetName();
  info.crs_name = name == nullptr ? "" : name;
  char* text = nullptr;
  const std::array<const char*, 2> options{"FORMAT=WKT2_2019", nullptr};
  crs.exportToWkt(&text, options.data());
  const CplText owned(text);
  info.crs_wkt = text == nullptr ? "" : text;
  info.semi_major_axis_m = crs.GetSemiMajor();
  // Local and polar radii are in use as spheres, so a body is a range.
  const double a = info.semi_major_axis_m;
  if (a > 3'370'000.0 && a < 3'400'000.0) {
    info.body = "Mars";
  } else if (a > 1'734'000.0 && a < 1'740'000.0) {
    info.body = "Moon";
  } else if (a > 6'350'000.0 && a < 6'380'000.0) {
    info.body = "Earth";
  } else {
    info.body = "other";
  }
}

}  // namespace slipway::dem
