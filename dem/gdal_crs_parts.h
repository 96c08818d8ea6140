#pragma once

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

// Heights and places are two matters: cells are placed by the horizontal part of a system alone, so that no
// grid of a geoid, which one machine has and another lacks, ever changes a height.
namespace slipway::dem {

// The part of a system that places cells: without its vertical part, its third axis and its bond to another
// datum. Nothing of no system.
std::unique_ptr<OGRSpatialReference> horizontal_part(const OGRSpatialReference* crs);

// What a system says of heights.
struct VerticalPart {
  std::string name;                       // of its datum's heights: "EGM96 height"; empty: not stated
  std::optional<double> metres_per_unit;  // of its axis
  std::string unit;                       // its name
};
VerticalPart vertical_part(const OGRSpatialReference* crs);

// What the label at the start of a PDS or ISIS file has for a key, by the first line that has it.
std::optional<std::string> label_value(const std::filesystem::path& file, std::string_view key);

// Whether the label of a PDS or ISIS file counts longitudes towards the west, which GDAL does not heed.
bool has_west_positive_label(const std::filesystem::path& file);

// The horizontal part of the system that an open raster names, by GDAL and by its label.
std::unique_ptr<OGRSpatialReference> system_of(GDALDataset& dataset);

// Why a projection is none that a map can be in, as one that shrinks the body to a point; nothing where that
// is not so. With the command that states a usable one.
std::optional<std::string> fault_of_scale(const OGRSpatialReference& crs, const std::string& file);

}  // namespace slipway::dem
