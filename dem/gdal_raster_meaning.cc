#include "dem/gdal_raster_meaning.h"

#include <cpl_minixml.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>

#include "dem/gdal_crs.h"
#include "dem/gdal_crs_parts.h"

namespace slipway::dem {
namespace {

bool has_any(std::string text, std::initializer_list<std::string_view> words) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return text.find(word) != std::string::npos; });
}

// Whether a description is that of something about heights which is none.
bool is_about_heights(const std::string& description) {
  return has_any(description, {"precision", "error", "uncert", "sigma", "std", "deviation", "quality",
                               "count", "number", "densit", "differ", "mask", "slope", "aspect", "shade",
                               "rough", "confidence", "weight", "orthophoto"});
}
bool is_height(const std::string& description) {
  return !is_about_heights(description) &&
         has_any(description, {"elev", "height", "altitude", "topograph", "dem", "dtm", "dsm", "radius"});
}

std::string in_quotes(const std::string& text) {
  return '"' + text + '"';
}

// The bands beside that of opacity.
std::vector<int> data_bands(GDALDataset& dataset) {
  std::vector<int> bands;
  for (int band = 1; band <= dataset.GetRasterCount(); ++band)
    if (dataset.GetRasterBand(band)->GetColorInterpretation() != GCI_AlphaBand) bands.push_back(band);
  return bands;
}

std::string listed(GDALDataset& dataset, const std::vector<int>& bands) {
  std::string text;
  for (const int number : bands) {
    const GDALRasterBand& band = *dataset.GetRasterBand(number);
    text += fmt::format("{}{}", text.empty() ? "" : ", ", number);
    if (*band.GetDescription() != '\0') text += " " + in_quotes(band.GetDescription());
  }
  return text;
}

bool is_colour(GDALColorInterp meaning) {
  return meaning >= GCI_RedBand && meaning != GCI_AlphaBand && meaning <= GCI_YCbCr_CrBand;
}

bool is_coloured(GDALDataset& dataset) {
  const auto bands = data_bands(dataset);
  return bands.size() >= 3 && std::all_of(bands.begin(), bands.end(), [&](int band) {
           return is_colour(dataset.GetRasterBand(band)->GetColorInterpretation());
         });
}

// The only one of these that a rule fits; 0 where none or several are.
template <class Rule>
int the_only(const std::vector<int>& bands, const Rule& rule) {
  return std::count_if(bands.begin(), bands.end(), rule) == 1
             ? *std::find_if(bands.begin(), bands.end(), rule)
             : 0;
}

}  // namespace

Result<BandChoice> choose_band(GDALDataset& dataset, const std::string& file, int wanted) {
  const auto chosen = [&](int band, std::string why) {
    return BandChoice{band, dataset.GetRasterBand(band)->GetDescription(), std::move(why), false};
  };
  const std::vector<int> bands = data_bands(dataset);
  if (wanted != 0) {
    if (std::find(bands.begin(), bands.end(), wanted) != bands.end())
      return BandChoice{wanted, dataset.GetRasterBand(wanted)->GetDescription(), "as asked for", true};
    return fail(ErrorCode::kUnreadableRaster,
                fmt::format("{} has no band {} of heights, its bands are {}.", file, wanted,
                            bands.empty() ? "none" : listed(dataset, bands)));
  }
  if (bands.size() == 1) return chosen(bands.front(), "");
  if (is_coloured(dataset)) return chosen(bands.front(), "");  // a picture, see fault_of_picture()
  const int described =
      the_only(bands, [&](int band) { return is_height(dataset.GetRasterBand(band)->GetDescription()); });
  if (described != 0) return chosen(described, "by its description");
  const int measured = the_only(bands, [&](int band) {
    const std::string unit = dataset.GetRasterBand(band)->GetUnitType();
    return !unit.empty() && metres_of_unit(unit).has_value();
  });
  if (measured != 0) return chosen(measured, "by its unit");
  return fail(ErrorCode::kUnreadableRaster,
              fmt::format("{} has {} bands, must be 1 or a chosen one: {}. Choose the one of heights with "
                          "--band, or take it out with: gdal_translate -b 1 {} {}",
                          file, bands.size(), bands.empty() ? "none" : listed(dataset, bands),
                          shell_word(file), shell_word(converted_name(file))));
}

std::optional<std::string> fault_of_picture(GDALDataset& dataset, const BandChoice& choice,
                                            const std::string& file, bool unit_is_stated) {
  const int number = choice.number;
  GDALRasterBand& band = *dataset.GetRasterBand(number);
  const GDALColorInterp colour = band.GetColorInterpretation();
  if (band.GetColorTable() != nullptr || colour == GCI_PaletteIndex)
    return fmt::format(
        "{} holds numbers of a palette's colours in band {}: it is a picture of a map, not heights. Import "
        "the raster that it was drawn of.",
        file, number);
  const bool is_narrow = GDALGetDataTypeSizeBits(band.GetRasterDataType()) <= 8;
  if (is_colour(colour) && (is_narrow || (is_coloured(dataset) && !choice.is_asked))) {
    std::string told =
        fmt::format("{} holds colours in band {}: it is a picture, not heights.", file, number);
    if (is_coloured(dataset) && is_narrow)
      told += fmt::format(
          " If these colours are heights in Terrarium's code, decode them with: gdal_calc.py -A {0} "
          "--A_band=1 "
          "-B {0} --B_band=2 -C {0} --C_band=3 --calc='A.astype(float)*256+B+C/256.0-32768' --type=Float32 "
          "--outfile={1}",
          shell_word(file), shell_word(converted_name(file)));
    if (!is_narrow) told += " If one of its bands holds heights, choose it with --band.";
    return told;
  }
  if (!is_narrow) return std::nullopt;
  int given = 0;
  const bool is_scaled = band.GetScale(&given) != 1.0 || band.GetOffset(&given) != 0.0;
  if (unit_is_stated || is_scaled) return std::nullopt;
  return fmt::format(
      "{} holds numbers of 8 bits without a unit in band {}, as a shaded relief or a photograph does. If "
      "they "
      "are heights, state their unit: with --unit m for an import, or in the file with: gdal_edit.py -units "
      "m "
      "{}",
      file, number, shell_word(file));
}

namespace {

std::string name_of(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

std::string sidecar_of(GDALDataset& dataset) {
  return std::string(dataset.GetDescription()) + ".aux.xml";
}

// What the raster says without the .aux.xml beside it; nothing where there is no such file.
struct Bare {
  GDALDatasetUniquePtr dataset;
  std::string sidecar;
};
Bare without_sidecar(GDALDataset& dataset) {
  Bare bare;
  std::error_code ignored;
  if (!std::filesystem::exists(sidecar_of(dataset), ignored)) return bare;
  bare.sidecar = name_of(sidecar_of(dataset));
  const SidecarReading none(false);
  bare.dataset.reset(GDALDataset::Open(dataset.GetDescription(), GDAL_OF_RASTER | GDAL_OF_READONLY,
                                       allowed_raster_drivers(), nullptr, nullptr));
  return bare;
}

// " from dem.tif.aux.xml" where the sidecar says something else than the file.
class Origin {
 public:
  Origin(GDALDataset& dataset, int band) : dataset_(dataset), bare_(without_sidecar(dataset)), band_(band) {}

  template <class Property>
  std::string of(const Property& property) const {
    return differs(property) ? " from " + bare_.sidecar : "";
  }
  std::string of_place() const {
    if (!bare_.dataset) return "";
    std::array<double, 6> with{}, without{};
    const bool had = bare_.dataset->GetGeoTransform(without.data()) == CE_None;
    const bool has = dataset_.GetGeoTransform(with.data()) == CE_None;
    const OGRSpatialReference *const crs = dataset_.GetSpatialRef(), *const before =
                                                                         bare_.dataset->GetSpatialRef();
    const bool same_crs = crs == nullptr || (before != nullptr && crs->IsSame(before) != 0);
    return had == has && with == without && same_crs ? "" : ", its place from " + bare_.sidecar;
  }

 private:
  template <class Property>
  bool differs(const Property& property) const {
    if (!bare_.dataset || bare_.dataset->GetRasterCount() < band_) return false;
    return property(*dataset_.GetRasterBand(band_)) != property(*bare_.dataset->GetRasterBand(band_));
  }
  GDALDataset& dataset_;
  Bare bare_;
  int band_;
};

// The unit that is stated by the band, else by the vertical system, else by a PDS label.
void read_unit(GDALDataset& dataset, const OGRSpatialReference* stated, RasterMeaning& meaning) {
  VerticalPart vertical = vertical_part(stated);
  if (vertical.name.empty()) vertical = vertical_part(dataset.GetSpatialRef());
  meaning.vertical_datum = vertical.name;
  if (meaning.unit.empty()) meaning.unit = dataset.GetRasterBand(meaning.band.number)->GetUnitType();
  if (meaning.unit.empty() && vertical.metres_per_unit) {
    meaning.unit = vertical.unit;
    meaning.metres_per_unit = vertical.metres_per_unit;
    return;
  }
  const bool is_pds = dataset.GetDriver() != nullptr && std::string_view(dataset.GetDriverName()) == "PDS";
  if (meaning.unit.empty() && is_pds) {
    const auto labelled = label_value(dataset.GetDescription(), "UNIT");
    if (labelled && metres_of_unit(*labelled)) meaning.unit = *labelled;
  }
  meaning.metres_per_unit = metres_of_unit(meaning.unit);
  if (vertical.metres_per_unit && meaning.metres_per_unit &&
      std::abs(*vertical.metres_per_unit - *meaning.metres_per_unit) > 1e-9)
    meaning.warnings.push_back(
        fmt::format("the band's unit is \"{}\", that of the vertical system {} m: the band's was taken",
                    meaning.unit, *vertical.metres_per_unit));
}

std::string told_of(GDALDataset& dataset, const RasterMeaning& meaning) {
  const Origin from(dataset, meaning.band.number);
  const HeightEncoding& encoding = meaning.encoding;
  std::string text = fmt::format("heights: band {}", meaning.band.number);
  if (!meaning.band.description.empty()) text += " " + in_quotes(meaning.band.description);
  if (!meaning.band.why.empty()) text += fmt::format(" ({})", meaning.band.why);
  text += meaning.metres_per_unit == 1.0 ? ", metres" : fmt::format(", in \"{}\"", meaning.unit);
  text += from.of([](GDALRasterBand& band) { return std::string(band.GetUnitType()); });
  if (encoding.scale != 1.0 || encoding.offset_m != 0.0)
    text += fmt::format(", scale {} and offset {}", encoding.scale, encoding.offset_m) +
            from.of([](GDALRasterBand& band) { return std::pair(band.GetScale(), band.GetOffset()); });
  text += encoding.has_nodata ? fmt::format(", nodata {:.9g}", encoding.wide_nodata) : ", no nodata value";
  text += from.of([](GDALRasterBand& band) {
    int given = 0;
    const double nodata = band.GetNoDataValue(&given);
    return std::pair(given != 0, given != 0 && nodata == nodata ? nodata : 0.0);
  });
  if (encoding.alpha_band != 0) text += fmt::format(", transparent where band {} is 0", encoding.alpha_band);
  if (encoding.has_mask) text += ", with a mask";
  if (encoding.is_sparse) text += ", blocks that the file lacks have none";
  text += from.of_place();
  return text + (meaning.vertical_datum.empty()
                     ? ", vertical datum not stated"
                     : fmt::format(", vertical datum {} (not shifted)", meaning.vertical_datum));
}

}  // namespace

std::optional<std::string> fault_of_sidecar(GDALDataset& dataset) {
  const std::string sidecar = sidecar_of(dataset);
  std::error_code ignored;
  if (!std::filesystem::exists(sidecar, ignored)) return std::nullopt;
  CPLXMLNode* const read = CPLParseXMLFile(sidecar.c_str());
  const bool is_whole = read != nullptr;
  CPLDestroyXMLNode(read);
  if (is_whole) return std::nullopt;
  return fmt::format(
      "{} lies beside the map and can't be read, though scale, unit and missing heights may be in it. Fetch "
      "it "
      "again, or move it away: mv {} {}",
      name_of(sidecar), shell_word(name_of(sidecar)), shell_word(name_of(sidecar) + ".damaged"));
}

RasterMeaning meaning_of(GDALDataset& dataset, const BandChoice& choice, const StatedMeaning& stated) {
  RasterMeaning meaning;
  meaning.band = choice;
  meaning.unit = stated.unit;
  GDALRasterBand& band = *dataset.GetRasterBand(choice.number);
  meaning.encoding = encoding_of(band);
  read_unit(dataset, stated.system, meaning);
  if (meaning.unit.empty()) meaning.on_trust.emplace_back("heights are metres: no unit is stated");
  if (meaning.vertical_datum.empty())
    meaning.on_trust.emplace_back("heights are above the map's own datum: no vertical one is stated");
  if (is_about_heights(choice.description))
    meaning.warnings.push_back(fmt::format("band {} is described as {}, which is no height", choice.number,
                                           in_quotes(choice.description)));
  if (GDALGetDataTypeSizeBits(band.GetRasterDataType()) <= 8)
    meaning.warnings.push_back(fmt::format(
        "heights are whole numbers of 8 bits: the ground has steps of {} m, which slopes and steps show",
        std::abs(meaning.encoding.scale) * meaning.metres_per_unit.value_or(1.0)));
  meaning.told = told_of(dataset, meaning);
  return meaning;
}

Result<void> check_metres(const RasterMeaning& meaning, const std::string& file) {
  if (meaning.metres_per_unit == 1.0) return check_scale(meaning.encoding, file);
  const double metres = meaning.metres_per_unit.value_or(0.3048);
  std::string sum = fmt::format("A*{}", meaning.encoding.scale * metres);
  if (meaning.encoding.offset_m != 0.0) sum += fmt::format("+{}", meaning.encoding.offset_m * metres);
  return fail(
      ErrorCode::kUnreadableRaster,
      fmt::format("{} has heights in \"{}\", must be metres. {}gdal_calc.py -A {} --A_band={} "
                  "--calc={} --type=Float32 --outfile={}{}.",
                  file, meaning.unit,
                  meaning.metres_per_unit ? "Convert it with: " : "State their unit with --unit, or: ",
                  shell_word(file), meaning.band.number, shell_word(sum), shell_word(converted_name(file)),
                  meaning.metres_per_unit ? "" : ", with the factor of that unit (0.3048 for feet)"));
}

}  // namespace slipway::dem
