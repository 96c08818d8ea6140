#include "dem/crs/crs_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <regex>
#include <vector>

namespace slipway::dem {
namespace {

constexpr std::string_view kForms =
    "must be a code such as IAU_2015:49910, a PROJ string such as +proj=eqc +R=3396190 +units=m, WKT or "
    "PROJJSON, none of which may name a file or an address";

// Of projections and of bodies. Left out on purpose: init, the keys of grids and catalogues, and those of
// operations.
constexpr std::array<std::string_view, 81> kProjKeys{
    "proj",    "type",    "no_defs", "wktext",  "over",    "units",   "vunits",  "to_meter", "vto_meter",
    "axis",    "pm",      "datum",   "towgs84", "ellps",   "a",       "b",       "e",        "es",
    "f",       "rf",      "R",       "R_A",     "R_V",     "R_C",     "R_a",     "R_g",      "R_h",
    "R_lat_a", "R_lat_g", "k",       "k_0",     "x_0",     "y_0",     "z_0",     "h_0",      "lat_0",
    "lat_1",   "lat_2",   "lat_3",   "lat_b",   "lat_ts",  "lon_0",   "lon_1",   "lon_2",    "lon_3",
    "lonc",    "alpha",   "gamma",   "azi",     "tilt",    "h",       "sweep",   "zone",     "south",
    "north",   "approx",  "algo",    "no_off",  "no_uoff", "no_rot",  "no_cut",  "ns",       "guam",
    "bns",     "W",       "M",       "m",       "n",       "q",       "s",       "theta",    "hyperbolic",
    "o_proj",  "o_lat_p", "o_lon_p", "o_alpha", "o_lat_c", "o_lon_c", "o_lat_1", "o_lon_1",  "rot"};

// Of PROJ's database, and of the systems that OGC names.
const std::regex& code_form() {
  static const std::regex form(
      R"((?:urn:ogc:def:crs:)?(?:EPSG|ESRI|IAU|IAU_[0-9]{4}|IGNF|NKG|OGC|CRS)(?::[0-9.]*)?:[A-Za-z0-9_.+-]+)",
      std::regex::icase);
  return form;
}

const std::regex& wkt_form() {
  static const std::regex form(R"(^[A-Z][A-Z_]*\s*[\[(])", std::regex::icase);
  return form;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

std::string small_letters(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return small;
}

bool is_number_or_word(std::string_view value) {
  return std::all_of(value.begin(), value.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("+-._,'\"").find(c) != std::string_view::npos;
  });
}

std::optional<std::string> fault_of_proj_string(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n+";
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n"));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    const std::string_view setting = word.substr(std::min(word.find_first_not_of(kBlanks), word.size()));
    if (setting.empty()) continue;
    const std::string_view key = setting.substr(0, setting.find('='));
    if (std::find(kProjKeys.begin(), kProjKeys.end(), key) == kProjKeys.end())
      return fmt::format(
          "has the PROJ key {}, which is not read here: state the projection, its numbers and "
          "the body's radius alone, such as +proj=eqc +R=3396190 +units=m",
          key);
    if (!is_number_or_word(setting.substr(key.size() + (key.size() < setting.size() ? 1 : 0))))
      return fmt::format("has a value of the PROJ key {} that is neither a number nor a word", key);
  }
  return std::nullopt;
}

// WKT and PROJJSON can carry a PROJ string and the names of files of grids. A name needs no escaped letters.
std::optional<std::string> fault_of_tree(std::string_view text) {
  const std::string small = small_letters(text);
  std::string dense = small;
  std::erase_if(dense, [](unsigned char c) { return std::isspace(c) != 0; });
  for (const std::string_view part :
       {"parameterfile", "extension[", "extension(", "\"boundcrs\"", "\"proj ", "\\u"})
    if (small.find(part) != std::string::npos || dense.find(part) != std::string::npos)
      return fmt::format(
          "has {} in it, which can name a file: state the system by its code, or as a PROJ "
          "string such as +proj=eqc +R=3396190 +units=m",
          part);
  return std::nullopt;
}

}  // namespace

std::optional<std::string> fault_of_crs_text(std::string_view text) {
  // The standard library's expressions call themselves for each letter.
  constexpr std::size_t kLongestCode = 200, kLongestKey = 40;
  const std::string name(trimmed(text));
  if (name.size() <= kLongestCode && std::regex_match(name, code_form())) return std::nullopt;
  if (name.starts_with('{') || std::regex_search(name.substr(0, kLongestKey), wkt_form()))
    return fault_of_tree(name);
  if (name.starts_with('+')) return fault_of_proj_string(name);
  return std::string(kForms);
}

}  // namespace slipway::dem
