#pragma once

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "dem/gdal_heights.h"
#include "dem/gdal_raster.h"

// What the numbers of a raster mean is decided here and nowhere else.
namespace slipway::dem {

// The band that is read.
struct BandChoice {
  int number = 1;
  std::string description;  // as the file has it; mostly empty
  std::string why;          // it was taken of several; empty where it is the only one
  bool is_asked = false;    // by a person
};

// The band of heights: the one that is wanted (0: none is), the only one beside opacity, the only one that is
// described as a height, or the only one in a unit of length. Errors: unreadable_raster, with the bands that
// there are.
Result<BandChoice> choose_band(GDALDataset& dataset, const std::string& file, int wanted);

// Why a band is a picture and no heights; nothing where it may be some. A stated unit says that they are.
std::optional<std::string> fault_of_picture(GDALDataset& dataset, const BandChoice& band,
                                            const std::string& file, bool unit_is_stated);

// Why the .aux.xml beside a raster can't be read, which GDAL would pass over; nothing where it can or is
// none.
std::optional<std::string> fault_of_sidecar(GDALDataset& dataset);

struct RasterMeaning {
  BandChoice band;
  HeightEncoding encoding;
  std::string unit;                       // as it is stated; empty: it is not
  std::optional<double> metres_per_unit;  // nothing of a unit that is not known
  std::string vertical_datum;             // empty: not stated
  std::vector<std::string> warnings;      // what is likely wrong
  std::vector<std::string> on_trust;      // what nobody stated
  std::string told;                       // "heights: band 1, metres, nodata -9999, ..."
};

// What a person says in place of the file.
struct StatedMeaning {
  std::string unit = {};                        // empty: the file's
  const OGRSpatialReference* system = nullptr;  // whose vertical part counts where it has one
};

// Everything that file, label and sidecars say of a band.
RasterMeaning meaning_of(GDALDataset& dataset, const BandChoice& band, const StatedMeaning& stated = {});

// Heights must be metres, and scale and offset must make some. Errors: unreadable_raster, with the command
// that converts `file`.
Result<void> check_metres(const RasterMeaning& meaning, const std::string& file);

}  // namespace slipway::dem
