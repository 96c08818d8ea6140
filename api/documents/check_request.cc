#include "api/documents/check_request.h"

#include "api/documents/drive_assumptions.h"
#include "api/documents/drive_commands.h"
#include "api/documents/zones.h"
#include "api/json/faults.h"
#include "api/json/parse.h"

namespace slipway::api::json {
namespace {

// `under_way`: the request has a drive so far, from whose last place the way may begin.
void read_way(ObjectReader& reader, bool under_way, CheckRequest& request, std::vector<Fault>& faults) {
  const JsonValue* const start = reader.member("start", kOptional);
  const JsonValue* const commands = reader.member("commands", kOptional);
  if (start == nullptr && commands == nullptr) {
    const std::size_t least = under_way ? 1 : 2;
    for (const Element& element : reader.list("path", kRequired, {least, RequestLimits::kPathCorners}))
      read_waypoint(*element.value, element.pointer, request.path.emplace_back(), faults);
    return;
  }
  if (reader.member("path", kOptional) != nullptr)
    reader.fault("path", "path and commands exclude each other");
  if (start == nullptr && !under_way) {
    reader.fault("start",
                 "start is missing: commands begin where the rover stands, with x_m, y_m and yaw_deg");
  } else if (start != nullptr) {
    read_waypoint(*start, "/start", request.path.emplace_back(), faults);
    if (!request.path.back().yaw_rad && !has_fault_under(faults, "/start"))
      reader.fault("start", "start must have yaw_deg: commands begin with the rover's heading");
  }
  read_commands(reader, request.commands);
}

// The rest of a drive under way: a path of one corner leads there from where it is, and commands begin there.
void begin_where_it_is(ObjectReader& reader, CheckRequest& request, std::vector<Fault>& faults) {
  const auto place = place_reached(request.drive);
  if (!place || has_fault_under(faults, "/drive_so_far")) return;
  if (request.commands.empty()) {
    go_on_from_place_reached(request.drive, request.path);
  } else if (request.path.empty() && !has_fault_under(faults, "/start")) {
    request.path.push_back(*place);
    if (!place->yaw_rad)
      reader.fault("start",
                   "start is missing: commands begin with the rover's heading, and the last row of "
                   "drive_so_far has no yaw_deg");
  }
}

}  // namespace

Result<Reading<CheckRequest>> read_check_request(std::string_view bytes,
                                                 const std::map<std::string, RuleSet, std::less<>>& rules) {
  const auto document = parse(bytes, {.bytes = RequestLimits::kBodyBytes});
  if (!document) return fail(document.error());
  Reading<CheckRequest> reading;
  CheckRequest& request = reading.request;
  ObjectReader reader(*document, "", reading.faults);
  if (!reader.is_object()) return reading;
  read_names(reader, request.terrain, request.rover);
  read_way(reader, document->find("drive_so_far") != nullptr, request, reading.faults);
  reader.boolean("backwards", kOptional, request.manner.backwards);
  reader.angle_deg("crab_deg", kOptional, {"deg", -90.0, 90.0}, request.manner.crab_rad);
  if (reader.text("rules", kOptional, {.most = 64, .is_name = true}, request.rules)) {
    const auto found = rules.find(request.rules);
    if (found != rules.end()) {
      static_cast<DriveRules&>(request.drive) = found->second.rules;
    } else {
      std::vector<std::string> names;
      for (const auto& [name, set] : rules) names.push_back(name);
      reader.fault("rules", unknown_name("set of rules", request.rules, names));
    }
  }
  read_zones(reader, request.keep_out, request.keep_in, reading.faults);
  read_drive_assumptions(reader, request.drive);
  begin_where_it_is(reader, request, reading.faults);
  reader.refuse_unknown();
  return reading;
}

std::string write_check_request(const CheckRequest& request) {
  Writer w;
  w.begin_object();
  w.text("terrain", request.terrain).text("rover", request.rover);
  if (request.commands.empty()) {
    w.key("path").begin_array();
    for (const planner::Waypoint& corner : request.path) write_waypoint(w, corner);
    w.end_array();
  } else {
    write_waypoint(w.key("start"), request.path.front());
    write_commands(w, request.commands);
  }
  w.boolean("backwards", request.manner.backwards).angle_deg("crab_deg", request.manner.crab_rad);
  if (!request.rules.empty()) w.text("rules", request.rules);
  if (!request.keep_out.empty() || !request.keep_in.empty())
    write_zones(w, request.keep_out, request.keep_in);
  write_drive_assumptions(w, request.drive);
  w.end_object();
  return w.take();
}

}  // namespace slipway::api::json
