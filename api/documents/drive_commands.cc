#include "api/documents/drive_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "api/documents/drive_assumptions.h"

namespace slipway::api::json {
namespace {

constexpr std::size_t kMaxCommands = 1000;
constexpr int kMaxRepeats = 1000;

void read_command(const Element& element, std::vector<planner::DriveStep>& commands,
                  std::vector<Fault>& faults) {
  ObjectReader row(*element.value, element.pointer, faults);
  if (!row.is_object()) return;
  planner::DriveStep step;
  const bool drives = row.number("drive_m", kOptional, {"m", 0.0, 1000.0, true}, step.drive_m);
  const bool arcs = row.number("arc_m", kOptional, {"m", 0.0, 1000.0, true}, step.drive_m);
  const bool turns = row.angle_deg("turn_deg", kOptional, {"deg", -360.0, 360.0}, step.turn_rad);
  if (arcs && row.number("radius_m", kRequired, {"m", -1e6, 1e6}, step.radius_m) &&
      std::abs(step.radius_m) < 0.01)
    row.fault("radius_m", "radius_m must be 0.01 m or more to the left, or as much below 0 to the right");
  int repeats = 1;
  row.whole("repeat", kOptional, 1, kMaxRepeats, repeats);
  row.refuse_unknown();
  if (static_cast<int>(drives) + static_cast<int>(arcs) + static_cast<int>(turns) != 1) {
    faults.push_back({element.pointer, "a command has exactly one of drive_m, arc_m and turn_deg"});
    return;
  }
  if (commands.size() + static_cast<std::size_t>(repeats) > kMaxCommands) {
    faults.push_back(
        {element.pointer, fmt::format("there must be at most {} commands, repeats counted", kMaxCommands)});
    return;
  }
  commands.insert(commands.end(), static_cast<std::size_t>(repeats), step);
}

void write_command(Writer& w, const planner::DriveStep& step) {
  w.begin_object();
  if (step.drive_m <= 0.0)
    w.angle_deg("turn_deg", step.turn_rad);
  else if (step.radius_m == 0.0)
    w.exact("drive_m", step.drive_m);
  else
    w.exact("arc_m", step.drive_m).exact("radius_m", step.radius_m);
  w.end_object();
}

// What a plan's request has and a check's has not.
constexpr std::array<std::string_view, 10> kOfPlansAlone{"start",    "start_error", "goal",   "waypoints",
                                                         "weights",  "ranking",     "routes", "verify",
                                                         "planners", "commands"};

Result<const JsonValue*> row_of(const JsonValue& plan, int route) {
  const JsonValue* const summary = plan.find("summary");
  const std::size_t count = summary == nullptr ? 0 : summary->elements.size();
  if (route < 1 || static_cast<std::size_t>(route) > count) {
    const std::string why = fmt::format("route = {}, the plan has {}", route,
                                        count == 0   ? "no route"
                                        : count == 1 ? "1 route"
                                                     : fmt::format("{} routes", count));
    return fail(ErrorCode::kInvalidRequest, why, {{"/route", why}});
  }
  const JsonValue& row = summary->elements[static_cast<std::size_t>(route) - 1];
  if (row.find("commands") != nullptr && row.find("start") != nullptr && plan.find("request") != nullptr &&
      plan.find("terrain") != nullptr && plan.find("rover") != nullptr)
    return &row;
  const std::string why = "the plan was made by an earlier version, whose routes have no commands";
  return fail(ErrorCode::kInvalidRequest, why, {{"/route", why}});
}

}  // namespace

void read_commands(ObjectReader& reader, std::vector<planner::DriveStep>& commands) {
  for (const Element& element : reader.list("commands", kRequired, {1, kMaxCommands}))
    read_command(element, commands, reader.faults());
}

void write_commands(Writer& w, const std::vector<planner::DriveStep>& commands) {
  w.key("commands").begin_array();
  for (const planner::DriveStep& step : commands) write_command(w, step);
  w.end_array();
}

void write_drive_steps(Writer& w, const planner::DriveSteps& steps) {
  write_waypoint(w.key("start"), {steps.start.x_m, steps.start.y_m, steps.start.yaw_rad});
  write_commands(w, steps.steps);
}

Result<std::string> check_of_route(const JsonValue& plan, int route) {
  const auto row = row_of(plan, route);
  if (!row) return fail(row.error());
  const JsonValue& request = *plan.find("request");
  Writer w;
  w.begin_object();
  for (std::size_t i = 0; i < request.keys.size(); ++i) {
    if (std::find(kOfPlansAlone.begin(), kOfPlansAlone.end(), request.keys[i]) == kOfPlansAlone.end())
      write_value(w.key(request.keys[i]), request.elements[i]);
  }
  for (const std::string_view key : {"start", "commands"}) write_value(w.key(key), *(*row)->find(key));
  w.end_object();
  return w.take();
}

Result<std::string> commands_table(const JsonValue& plan, int route) {
  const auto row = row_of(plan, route);
  if (!row) return fail(row.error());
  CommandsTable table{.terrain = plan.find("terrain")->text, .rover = plan.find("rover")->text};
  std::vector<Fault> faults;
  ObjectReader reader(**row, "", faults);
  read_waypoint(*(*row)->find("start"), "/start", table.start, faults);
  read_commands(reader, table.commands);
  if (!faults.empty()) return fail(ErrorCode::kInternal, "the plan's commands can't be read");
  return write_commands_csv(table);
}

std::string check_of_table(const CommandsTable& table) {
  Writer w;
  w.begin_object();
  if (!table.terrain.empty()) w.text("terrain", table.terrain);
  if (!table.rover.empty()) w.text("rover", table.rover);
  write_waypoint(w.key("start"), table.start);
  write_commands(w, table.commands);
  w.end_object();
  return w.take();
}

}  // namespace slipway::api::json
