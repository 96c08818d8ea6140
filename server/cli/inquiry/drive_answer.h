#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "server/cli/inquiry/ask_options.h"
#include "server/cli/inquiry/drive_options.h"
#include "server/cli/inquiry/exit_status.h"
#include "server/cli/inquiry/inquiry.h"

// What the answers to plans and predictions have in common.
namespace slipway::server {

// Files for what is made of an answer; empty: not wanted.
struct Pictures {
  std::string map = {}, history = {};
  std::string report = {};              // HTML, of a check
  std::string csv = {};                 // of the stations
  std::string gpkg = {}, geojson = {};  // of routes and stations
  bool lonlat = false;                  // the GeoJSON in degrees
  std::string commands = {};            // of a plan or a sol: those of a route, CSV in .csv, else JSON
  int route = 1;                        // whose commands
};

// Those that a drive's options name.
Pictures pictures_of(const DriveOptions& drive);

// Where places are in degrees, brings them to the terrain's map. Errors: those of inquiry(); not_found;
// off_map with every place that the map does not reach.
Result<void> bring_to_map(const AskOptions& ask, const std::string& terrain,
                          const std::vector<PlaceOption*>& places);

// Where --sky names kernels, makes the table of sun and Earth over the place where the drive starts: from the
// first departure until ten days and the light that is to be left behind the last; none where --depart is no
// time, which the request's reader says. `start` may be null where
// the request's file or the telemetry says it; then it must be given. Errors: those of inquiry(); not_found;
// of reading and using the kernels, as invalid_request.
Result<void> make_sky(const AskOptions& ask, DriveOptions& drive, const PlaceOption* start);

// Asks, draws what is wanted, then prints the document or its table. `placed` says of an error of the
// question where it stands in what the user wrote. The exit status: that of the document's verdict, where all
// went well.
int ask_and_print(const AskOptions& ask, const Pictures& pictures, const Result<std::string>& request,
                  Result<std::string> (Inquiry::*question)(const std::string&, Progress&),
                  Result<std::string> (*table)(std::string_view, bool why),
                  ExitStatus (*verdict)(std::string_view), const std::function<Error(Error)>& placed = {});

// The exit status of an answer's verdict; of a plan, of its best route's.
ExitStatus check_status(std::string_view check);
ExitStatus prediction_status(std::string_view prediction);
ExitStatus plan_status(std::string_view plan);

// The name of the rover to drive: the corrected one where a model is given and the rover that it was made of
// is asked for. Errors: those of reading the model; invalid_request where it says nothing of this rover,
// unless `any_rover` (a request from a file names its own).
Result<std::string> models_rover(const AskOptions& ask, const std::string& rover, bool any_rover);

}  // namespace slipway::server
