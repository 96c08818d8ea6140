#include "server/cli/inquiry/drive_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <exception>

#include "sim/prediction/rule_catalogue.h"
#include "sim/rover/wheel_failure.h"

namespace slipway::server {
namespace {

// "x,y" or "x,y,yaw_deg".
PlaceOption place_of(const std::string& text) {
  PlaceOption place;
  std::vector<double> numbers;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::string part = text.substr(begin, comma - begin);
    std::size_t used = 0;
    try {
      numbers.push_back(std::stod(part, &used));
    } catch (const std::exception&) {
      used = 0;
    }
    if (used == 0 || used != part.size() || !std::isfinite(numbers.back()))
      throw CLI::ValidationError("\"" + text + "\" must be x,y or x,y,yaw_deg in map metres");
    begin = comma + 1;
  }
  if (numbers.size() < 2 || numbers.size() > 3)
    throw CLI::ValidationError("\"" + text + "\" must be x,y or x,y,yaw_deg in map metres");
  place.x_m = numbers[0];
  place.y_m = numbers[1];
  if (numbers.size() == 3) place.yaw_deg = numbers[2];
  return place;
}

// One flag for each limit of the rule catalogue: max_tilt_deg is --max-tilt-deg.
void add_limits(CLI::App& command, DriveOptions& drive) {
  for (const sim::RuleRow& row : sim::rule_catalogue()) {
    if (!row.limit) continue;
    std::string flag = "--" + std::string(row.key);
    std::replace(flag.begin(), flag.end(), '_', '-');
    command.add_option_function<double>(
        flag, [&drive, &row](double value) { drive.limits[row.key] = value; },
        fmt::format("limit of the {}", row.help));
  }
}

}  // namespace

void add_place(CLI::App& command, const std::string& name, std::optional<PlaceOption>& place,
               const std::string& help) {
  command.add_option_function<std::string>(
      name, [&place](const std::string& text) { place = place_of(text); }, help);
}

void add_places(CLI::App& command, const std::string& name, std::vector<PlaceOption>& places,
                const std::string& help) {
  command.add_option_function<std::vector<std::string>>(
      name,
      [&places](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) places.push_back(place_of(text));
      },
      help);
}

void add_assumptions(CLI::App& command, DriveOptions& drive) {
  command.add_option("--terrain", drive.terrain, "name of the terrain")->capture_default_str();
  command.add_option("--rover", drive.rover, "name of the rover")->capture_default_str();
  add_limits(command, drive);
  command.add_option(
      "--keep-out", drive.keep_out,
      "an area that the rover's body must not enter: \"x,y x,y x,y\", or a GeoJSON file of polygons in map "
      "metres; may be repeated");
  command.add_option("--keep-in", drive.keep_in,
                     "an area that the rover's body must not leave, as --keep-out");
  command.add_option("--speed-m-s", drive.speed_m_s, "commanded speed");
  command.add_option("--slip-check-every-m", drive.slip_check_every_m,
                     "way that the wheels roll between two checks of the slip");
  command.add_option("--embedding-slip", drive.embedding_slip,
                     "slip over which the wheels dig rather than drive");
  command.add_option("--embedding-turns", drive.embedding_turns,
                     "turns at such a slip without a check that embed the rover");
  command.add_option("--embedding-sinkage-share", drive.embedding_sinkage_share,
                     "share of a wheel's radius, deeper than which the rover is embedded");
  command.add_option("--max-stop", drive.max_stop,
                     "GO below this probability of a halt, 0.2 where it is not given");
  command.add_option("--no-go-stop", drive.no_go_stop,
                     "NO-GO above this probability of a halt, 0.5 where it is not given");
  command.add_option("--max-immobilised", drive.max_immobilised,
                     "GO below, NO-GO above this probability that the ground holds the rover, 0.01 where it "
                     "is not given");
  command.add_option("--max-embedding", drive.max_embedding,
                     "GO below, NO-GO above this probability that the wheels dig in, 0.01 where it is not "
                     "given");
  command.add_option("--beliefs", drive.beliefs,
                     "file of soils (soils/1) that stand in for those of the same names, or beside them");
  command.add_option("--unknown-soil", drive.unknown_soil, "what unmapped ground is believed to be");
  command.add_option("--segment-m", drive.segment_m,
                     "decide the drive in segments of this length, as sols or stages; of a plan over a "
                     "kilometre and more 250 where it is not given");
  command.add_option("--confidence", drive.confidence,
                     "that a mapped class is the soil that the legend gives");
  command.add_option("--legend", drive.legend, "which of the terrain's legends says what its classes are");
  command.add_option(
      "--effect", drive.effects,
      "switch an effect on, NAME or NAME:parameter=value,..., or off, NAME:off; see slipway effects");
  command.add_option("--failed", drive.failed,
                     fmt::format("a wheel whose drive has failed, WHEEL={}",
                                 fmt::join(sim::wheel_failure_names(), " or WHEEL=")));
  command.add_option("--motor-temp-c", drive.motor_temp_c, "temperature of the drive motors");
  CLI::Option* const depart = command.add_option(
      "--depart", drive.depart,
      "when the drive may begin, FROM..TO in UTC, 2016-03-22T09:00:00Z..2016-03-22T14:00:00Z: says in which "
      "windows all that is asked of the day holds, and what the battery does");
  command
      .add_option("--day", drive.day,
                  "what is asked and known of the day, NAME=VALUE: every_min, charge_percent, optical_depth, "
                  "min_charge_percent, min_sun_deg, min_earth_deg, light_left_h, arrive_by, air.coldest_c, "
                  "air.warmest_c")
      ->needs(depart);
  command
      .add_option("--sky", drive.sky,
                  "directions of sun and Earth: a file with the list sky of a departure, or SPICE kernels of "
                  "positions "
                  "(SPK, as de440s.bsp) and constants (text PCK) of which it is made; on Mars they are "
                  "computed where it "
                  "is not given")
      ->needs(depart);
}

void add_drive(CLI::App& command, DriveOptions& drive) {
  add_assumptions(command, drive);
  command.add_option("--as-of-sol", drive.as_of_sol,
                     "drives of the terrain's table before this sol count as evidence of the ground");
  command.add_option("--drive-so-far", drive.drive_so_far,
                     "telemetry of a drive under way (CSV: driven_m,x_m,y_m and where known time_s, yaw_deg, "
                     "current_a): evidence of the ground, and the start is its last row unless one is given");
  command.add_flag("--relief", drive.relief,
                   "draw the relief too: the map's error, roughness and rocks, as the terrain states them");
  command.add_option(
      "--elevation-error-m", drive.elevation_error_m,
      "standard deviation of the map's heights in place of the terrain's value; draws the relief");
  command.add_option("--roughness-m", drive.roughness_m,
                     "the same of heights about the map's surface; draws the relief");
  command.add_option("--rock-share", drive.rock_share,
                     "share of the ground that rocks cover; draws the relief");
  command.add_option("--draws", drive.draws,
                     "draws of the ground for the risk; as many as the verdict needs where it is not given");
  command.add_option("--seed", drive.seed, "the same seed gives the same answer");
  command.add_option("--csv", drive.csv, "write the stations, one row each (CSV), to this file");
  command.add_option("--gpkg", drive.gpkg,
                     "write routes and stations in map metres (GeoPackage) to this file");
  command.add_option(
      "--geojson", drive.geojson,
      "write routes and stations (GeoJSON) to this file: map metres with their system, or degrees of the "
      "body with --lonlat");
  command.add_flag(
      "--lonlat", drive.lonlat,
      "places are given as longitude,latitude in degrees of the body (to the east; planetocentric but on "
      "the Earth), and the GeoJSON is in degrees; yaw and areas stay those of the map");
  command.add_option("--map", drive.map, "write a picture of the routes (SVG) to this file");
}

}  // namespace slipway::server
