#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/files/catalogue.h"
#include "api/requests/plan_request.h"
#include "core/result.h"
#include "planner/search/planner_catalogue.h"

namespace slipway::api {

// Gathers what is wrong with a request that was read: beside the reader's faults, those that only the
// catalogue and the terrain can tell. Where the reader already found fault with a value, nothing more is said
// of it.
class RequestCheck {
 public:
  RequestCheck(const Catalogue& catalogue, std::vector<Fault> reader_faults);

  void names(const std::string& terrain, const std::string& rover);
  // Soils that a model is asked to stand in for, by the request's own words or else by the service's: of
  // these the terrain has to have some.
  void ground(const std::optional<RequestedModel>& model, const std::vector<std::string>& of_service);
  void place(const planner::Waypoint& place, const std::string& pointer);
  // Places that follow each other on the way are not one place.
  void legs(const PlanRequest& request);
  // Areas that lie wholly off the map, with another reading of whose corners they would not: swapped, or in
  // degrees. Others may be of the ground around it.
  void zones(const std::vector<planner::Polygon>& zones, std::string_view pointer);
  void drive(const DriveAssumptions& drive);
  // among_zones: the request has keep-outs or keep-ins.
  void crab(double crab_rad, bool among_zones);
  void planners(const std::vector<std::string>& planners, std::span<const planner::PlannerRow> known);
  // A path no longer than RequestLimits::kPathLength_m.
  void path_length(const std::vector<planner::Waypoint>& path);

  bool passed() const { return faults_.empty(); }
  // The one error for all faults.
  Error error() const;

 private:
  void failed_wheels(const DriveAssumptions& drive);
  void drive_so_far(const DriveAssumptions& drive);
  void computed_sky(const DepartureRequest& departure);
  void departure(const DriveAssumptions& drive);
  void relief(const DriveAssumptions& drive);
  void doubled_closures(const DriveAssumptions& drive);
  void add(ErrorCode code, std::string pointer, std::string message);
  bool already_faulty(std::string_view pointer) const;

  const Catalogue& catalogue_;
  std::vector<std::pair<ErrorCode, Fault>> faults_;
  const TerrainSite* site_ = nullptr;
  const sim::RoverModel* rover_ = nullptr;
};

}  // namespace slipway::api
