#include "dem/gdal_crs_parts.h"

#include <cpl_conv.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string_view>

#include "dem/gdal_crs.h"

namespace slipway::dem {
namespace {

namespace fs = std::filesystem;

// A system that is bound to another one by a shift, without that shift: its own longitudes and latitudes
// stay.
std::unique_ptr<OGRSpatialReference> unbound(const OGRSpatialReference& crs) {
  auto alone = std::unique_ptr<OGRSpatialReference>(crs.Clone());
  char* text = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
  if (crs.exportToWkt(&text, options) != OGRERR_NONE) {
    CPLFree(text);
    return alone;
  }
  OGR_SRSNode root;
  const char* cursor = text;
  const bool is_bound = root.importFromWkt(&cursor) == OGRERR_NONE && EQUAL(root.GetValue(), "BOUNDCRS") &&
                        root.GetNode("SOURCECRS") != nullptr;
  CPLFree(text);
  if (!is_bound || root.GetNode("SOURCECRS")->GetChild(0)->exportToWkt(&text) != OGRERR_NONE) return alone;
  auto source = std::make_unique<OGRSpatialReference>();
  if (source->importFromWkt(text) == OGRERR_NONE) alone = std::move(source);
  CPLFree(text);
  return alone;
}

// The text at the start of a PDS or ISIS file.
std::string label_of(const fs::path& file) {
  constexpr std::size_t kMost = 1U << 18U;
  std::string text(kMost, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(text.data(), static_cast<std::streamsize>(kMost));
  text.resize(static_cast<std::size_t>(in.gcount()));
  text.resize(std::min(text.size(), text.find('\0')));
  return text;
}

// Without what surrounds it: blanks and quotes.
std::string plain_word(std::string text) {
  constexpr const char* kAround = " \t\r\"'";
  const std::size_t first = text.find_first_not_of(kAround);
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(kAround) + 1 - first);
}

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char one, unsigned char other) {
    return std::tolower(one) == std::tolower(other);
  });
}

}  // namespace

std::unique_ptr<OGRSpatialReference> horizontal_part(const OGRSpatialReference* crs) {
  if (crs == nullptr || crs->IsEmpty()) return nullptr;
  const std::unique_ptr<OGRSpatialReference> flat(crs->Clone());
  if (flat->IsCompound() != 0) flat->StripVertical();
  auto part = unbound(*flat);
  if (part->GetAxesCount() == 3 && part->IsGeocentric() == 0) part->DemoteTo2D(nullptr);
  part->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return part;
}

VerticalPart vertical_part(const OGRSpatialReference* crs) {
  VerticalPart part;
  if (crs == nullptr || crs->IsEmpty()) return part;
  if (crs->IsCompound() != 0) {
    const char* const name = crs->GetAttrValue("VERT_CS");
    part.name = name == nullptr ? "" : name;
    const char* unit = nullptr;
    part.metres_per_unit = crs->GetTargetLinearUnits("VERT_CS", &unit);
    part.unit = unit == nullptr ? "unit of the vertical system" : unit;
  } else if (crs->GetAxesCount() == 3 && crs->IsGeocentric() == 0) {
    part.name = "height above the ellipsoid";
  }
  return part;
}

std::optional<std::string> label_value(const fs::path& file, std::string_view key) {
  std::istringstream lines(label_of(file));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos || !same_word(plain_word(line.substr(0, equals)), key)) continue;
    return plain_word(line.substr(equals + 1));
  }
  return std::nullopt;
}

bool has_west_positive_label(const fs::path& file) {
  for (const char* key : {"POSITIVE_LONGITUDE_DIRECTION", "LongitudeDirection"})
    if (const auto value = label_value(file, key))
      return same_word(*value, "WEST") || same_word(*value, "PositiveWest");
  return false;
}

std::unique_ptr<OGRSpatialReference> system_of(GDALDataset& dataset) {
  auto system = horizontal_part(dataset.GetSpatialRef());
  const std::string driver = dataset.GetDriver() == nullptr ? "" : dataset.GetDriverName();
  if (!system || (driver != "ISIS3" && driver != "ISIS2" && driver != "PDS")) return system;
  // The label's longitudes are taken by GDAL as they stand. x grows towards the east in either case.
  const double meridian = system->GetProjParm(SRS_PP_CENTRAL_MERIDIAN, 0.0);
  if (meridian != 0.0 && has_west_positive_label(dataset.GetDescription()))
    system->SetProjParm(SRS_PP_CENTRAL_MERIDIAN, std::remainder(-meridian, 360.0));
  return system;
}

std::optional<std::string> fault_of_scale(const OGRSpatialReference& crs, const std::string& file) {
  if (crs.IsProjected() == 0) return std::nullopt;
  constexpr double kLeast = 0.01, kMost = 1.1;  // projections in use have 0.3 to 1.001
  OGRErr missing = OGRERR_NONE;
  const double scale = crs.GetProjParm(SRS_PP_SCALE_FACTOR, 1.0, &missing);
  if (missing != OGRERR_NONE || (scale >= kLeast && scale <= kMost)) return std::nullopt;
  OGRSpatialReference usable(crs);
  usable.SetProjParm(SRS_PP_SCALE_FACTOR, 1.0);
  return fmt::format(
      "{} is in \"{}\" with a scale factor of {}, under which no length of the map is that of the ground "
      "anywhere: its label has lost the true one. State the system that it was made in: with --crs for an "
      "import, or with: gdal_translate -a_srs {} {} {} (this one has the factor 1, which is a guess).",
      file, crs.GetName(), scale, shell_word(proj_words(usable)), shell_word(file),
      shell_word(converted_name(file)));
}

}  // namespace slipway::dem
