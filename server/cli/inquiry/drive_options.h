#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sky/sky.h"

namespace CLI {
class App;
}

namespace slipway::server {

// A point "x,y" or "x,y,yaw_deg".
struct PlaceOption {
  double x_m = 0.0, y_m = 0.0;
  std::optional<double> yaw_deg;
};

struct DriveOptions {
  std::string terrain = "gale";
  std::string rover = "msl-class";
  std::map<std::string_view, double> limits;  // by the keys of sim::rule_catalogue()
  std::optional<double> speed_m_s;
  std::optional<double> slip_check_every_m, embedding_slip, embedding_turns, embedding_sinkage_share;
  std::optional<double> max_embedding, max_immobilised, max_stop, no_go_stop;
  std::optional<int> as_of_sol;
  std::string drive_so_far;  // file with the telemetry of a drive under way; empty: none
  std::string beliefs;       // file with soils that stand in for the catalogue's; empty: none
  std::string legend, unknown_soil;
  std::optional<double> confidence;
  std::optional<double> segment_m;
  bool relief = false;
  std::optional<double> elevation_error_m, roughness_m, rock_share;
  std::optional<int> draws;
  std::optional<long long> seed;
  std::optional<double> motor_temp_c;
  std::optional<std::string> depart;           // "FROM" or "FROM..TO"
  std::vector<std::string> sky;                // a file with a table, or kernels
  std::vector<sky::SkySample> sky_of_kernels;  // what --sky gave, where these were kernels; see make_sky()
  std::vector<std::string> day;                // "charge_percent=80": a key of a departure
  std::vector<std::string> keep_out, keep_in;  // "x,y x,y x,y" or a GeoJSON file
  std::vector<std::string> failed;             // "rf=locked"
  std::vector<std::string> effects;            // "slip_sinkage", "slip_sinkage:n1=0.2" or "slip_sinkage:off"
  std::string map;                             // file for the picture; empty: none
  std::string csv;                             // file for the stations; empty: none
  std::string gpkg, geojson;                   // files for routes and stations; empty: none
  bool lonlat = false;                         // places in, and the GeoJSON out, are in degrees
};

// What plans, predictions and maps have in common: --terrain, --rover, limits, soils, effects, areas.
void add_assumptions(CLI::App& command, DriveOptions& drive);
// What plans and predictions have in common: the same, --draws, and files for what is made of the answer.
void add_drive(CLI::App& command, DriveOptions& drive);
// An option whose value is "x,y" or "x,y,yaw_deg".
void add_place(CLI::App& command, const std::string& name, std::optional<PlaceOption>& place,
               const std::string& help);
// The same with several values.
void add_places(CLI::App& command, const std::string& name, std::vector<PlaceOption>& places,
                const std::string& help);

}  // namespace slipway::server
