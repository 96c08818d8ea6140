#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/request_check.h"
#include "api/requests/answers.h"
#include "api/service.h"
#include "core/progress.h"
#include "dem/terrain.h"
#include "planner/problem/problem.h"

// What plans, predictions, checks and maps share: from a request's assumptions to a problem on the terrain.
namespace slipway::api {

// A problem without places, and the window's soils.
struct DriveSetting {
  planner::PlanProblem problem;
  Provenance provenance;
  std::shared_ptr<const TerrainSite> site;
};

// The ground is that of `window`, or lies around the places where that is not given.
Result<DriveSetting> set_up(const Service& service, const std::string& terrain, const std::string& rover,
                            const std::vector<planner::Waypoint>& places, const DriveAssumptions& drive,
                            Progress& progress, const std::optional<dem::Extent>& window = std::nullopt);

// The service's own, or a copy with the request's model and soils in it where it has some; the model's rover
// takes the place of the one it was made of. What can't be taken is added to the faults.
std::shared_ptr<const Catalogue> catalogue_for(const Service& service, const DriveAssumptions& drive,
                                               std::string& rover, std::vector<Fault>& faults);

// A request that was read, where neither its reader, nor `rest(request, check)`, nor what is checked of all
// drives finds a fault.
template <class Request, class Rest>
Result<Request> checked(const Service& service, Result<Reading<Request>> reading, const Rest& rest) {
  if (!reading) return fail(reading.error());
  Request& request = reading->request;
  const std::shared_ptr<const Catalogue> catalogue =
      catalogue_for(service, request.drive, request.rover, reading->faults);
  RequestCheck check(*catalogue, std::move(reading->faults));
  check.names(request.terrain, request.rover);
  check.ground(request.drive.model, service.options().ground);
  rest(request, check);
  check.drive(request.drive);
  if (!check.passed()) return fail(check.error());
  return std::move(request);
}

}  // namespace slipway::api
