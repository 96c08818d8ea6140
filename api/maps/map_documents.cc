#include "api/maps/map_documents.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "api/documents/drive_assumptions.h"
#include "api/documents/zones.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/maps/map_layer.h"

namespace slipway::api::json {
namespace {

using planner::MapKind;
using planner::MapKindRow;

constexpr NumberRule kExtentMetres{"m", -1e8, 1e8};
constexpr double kMaxDistance_m = 10'000.0;

bool is_of_distance(MapKind kind) {
  return kind == MapKind::kStopRisk || kind == MapKind::kEmbeddingRisk || kind == MapKind::kVerdict;
}

void read_extent(ObjectReader& reader, std::optional<dem::Extent>& extent) {
  auto object = reader.object("extent", kOptional);
  if (!object) return;
  dem::Extent read;
  const bool whole = object->number("west_m", kRequired, kExtentMetres, read.west_m) &
                     object->number("south_m", kRequired, kExtentMetres, read.south_m) &
                     object->number("east_m", kRequired, kExtentMetres, read.east_m) &
                     object->number("north_m", kRequired, kExtentMetres, read.north_m);
  object->refuse_unknown();
  if (whole && !(read.west_m < read.east_m && read.south_m < read.north_m))
    reader.fault("extent", "west_m must be less than east_m, and south_m less than north_m");
  if (whole) extent = read;
}

void read_map_kind(ObjectReader& reader, MapKind& kind) {
  std::vector<std::string_view> names;
  for (const MapKindRow& row : planner::map_kinds()) names.push_back(row.name);
  std::size_t chosen = 0;
  if (reader.choice("kind", kRequired, names, chosen)) kind = planner::map_kinds()[chosen].kind;
}

void read_way_place(ObjectReader& reader, const char* key, bool is_wanted,
                    std::optional<planner::Waypoint>& place) {
  const JsonValue* const value = reader.member(key, is_wanted ? kRequired : kOptional);
  if (value == nullptr) return;
  if (!is_wanted) {
    reader.fault(key, fmt::format("a map of this kind has no place {}", in_quotes(key)));
    return;
  }
  planner::Waypoint read;
  read_waypoint(*value, child_pointer("", key), read, reader.faults());
  place = read;
}

void read_budget(ObjectReader& reader, MapRequest& request) {
  auto object = reader.object("budget", request.kind == MapKind::kReachable ? kRequired : kOptional);
  if (!object) return;
  if (request.kind != MapKind::kReachable) reader.fault("budget", "is for the map of reachable ground alone");
  object->number("energy_j", kOptional, {"J", 0.0, 1e12, true}, request.budget_j);
  object->number("sols", kOptional, {"sols", 0.0, 1e5, true}, request.budget_sols);
  object->refuse_unknown();
  if (!request.budget_j && !request.budget_sols) reader.fault("budget", "must have energy_j, sols or both");
}

void read_map_weights(ObjectReader& reader, planner::Weights& weights) {
  auto object = reader.object("weights", kOptional);
  if (!object) return;
  for (std::size_t row = 0; row < weights.terms().size(); ++row) {
    const Field& field = weights.terms()[row].weight;
    object->number(field.name, kOptional, {field.unit, field.lowest, field.highest}, weights[row]);
  }
  object->refuse_unknown();
}

// What only a drive has.
void refuse_what_is_of_drives(ObjectReader& reader, const DriveAssumptions& drive) {
  const auto refuse = [&](bool given, const char* key) {
    if (given) reader.fault(key, "is of a drive; a map is made without it");
  };
  refuse(drive.draws.has_value(), "draws");
  refuse(drive.as_of_sol.has_value(), "as_of_sol");
  refuse(drive.drive_so_far.has_value(), "drive_so_far");
  refuse(drive.relief.has_value(), "relief");
  refuse(drive.departure.has_value(), "departure");
}

void write_classes(Writer& w, const MapAnswer& answer) {
  w.key("classes").begin_array();
  for (const dem::RasterClass& each : answer.layer.classes) {
    w.begin_object().whole("value", each.value).text("name", each.name);
    for (const auto& [name, cells] : answer.statistics.classes)
      if (name == each.name) w.whole("cells", cells);
    w.end_object();
  }
  w.end_array();
}

}  // namespace

Result<Reading<MapRequest>> read_map_request(std::string_view bytes,
                                             std::span<const planner::CostTerm> costs) {
  const auto document = parse(bytes, {.bytes = RequestLimits::kBodyBytes});
  if (!document) return fail(document.error());
  Reading<MapRequest> reading;
  MapRequest& request = reading.request;
  request.weights = planner::Weights(costs);
  ObjectReader reader(*document, "", reading.faults);
  if (!reader.is_object()) return reading;
  read_names(reader, request.terrain, request.rover);
  read_map_kind(reader, request.kind);
  const MapKindRow& row = planner::row_of(request.kind);
  const bool needs_heading = request.kind == MapKind::kSlip;
  if (reader.angle_deg("heading_deg", needs_heading ? kRequired : kOptional, {"deg", -360.0, 360.0},
                       request.heading_rad) &&
      !row.takes_heading)
    reader.fault("heading_deg", fmt::format("a map of {} is not of one heading", row.name));
  if (reader.number("distance_m", kOptional, {"m", 0.0, kMaxDistance_m, true}, request.distance_m) &&
      !is_of_distance(request.kind))
    reader.fault("distance_m", "is for risks and verdicts alone");
  read_extent(reader, request.extent);
  std::size_t unknown = 0;
  if (reader.choice("unknown_ground", kOptional, {"nodata", "belief"}, unknown)) {
    request.price_unknown = unknown == 1;
    if (row.of_classes || row.by_search) reader.fault("unknown_ground", "is for slip and risks alone");
  }
  read_way_place(reader, "to", request.kind == MapKind::kCostToGo, request.place);
  read_way_place(reader, "from", request.kind == MapKind::kReachable, request.place);
  read_budget(reader, request);
  if (reader.number("driving_hours_per_sol", kOptional, {"h", 0.0, 24.0, true},
                    request.driving_hours_per_sol) &&
      !request.budget_sols)
    reader.fault("driving_hours_per_sol", "is for a budget of sols alone");
  read_map_weights(reader, request.weights);
  if (request.kind != MapKind::kCostToGo && document->find("weights") != nullptr)
    reader.fault("weights", "are for the map of cost to go alone");
  read_zones(reader, request.keep_out, request.keep_in, reading.faults);
  if (!row.by_search && !(request.keep_out.empty() && request.keep_in.empty()))
    reader.fault(request.keep_out.empty() ? "keep_in" : "keep_out", "is for maps of ways alone");
  read_drive_assumptions(reader, request.drive);
  refuse_what_is_of_drives(reader, request.drive);
  reader.refuse_unknown();
  return reading;
}

std::string write_map_request(const MapRequest& request) {
  Writer w;
  w.begin_object().text("terrain", request.terrain).text("rover", request.rover);
  w.text("kind", planner::row_of(request.kind).name);
  if (request.heading_rad) w.angle_deg("heading_deg", *request.heading_rad);
  if (is_of_distance(request.kind)) w.exact("distance_m", request.distance_m);
  if (request.extent) {
    w.key("extent").begin_object().exact("west_m", request.extent->west_m);
    w.exact("south_m", request.extent->south_m).exact("east_m", request.extent->east_m);
    w.exact("north_m", request.extent->north_m).end_object();
  }
  const MapKindRow& kind = planner::row_of(request.kind);
  if (!kind.of_classes && !kind.by_search)
    w.text("unknown_ground", request.price_unknown ? "belief" : "nodata");
  if (request.place)
    write_waypoint(w.key(request.kind == MapKind::kCostToGo ? "to" : "from"), *request.place);
  if (request.budget_j || request.budget_sols) {
    w.key("budget").begin_object();
    if (request.budget_j) w.exact("energy_j", *request.budget_j);
    if (request.budget_sols) w.exact("sols", *request.budget_sols);
    w.end_object();
  }
  if (request.budget_sols) w.exact("driving_hours_per_sol", request.driving_hours_per_sol);
  if (request.kind == MapKind::kCostToGo) {
    w.key("weights").begin_object();
    for (std::size_t row = 0; row < request.weights.terms().size(); ++row)
      w.exact(request.weights.terms()[row].weight.name, request.weights[row]);
    w.end_object();
  }
  if (kind.by_search) write_zones(w, request.keep_out, request.keep_in);
  write_drive_assumptions(w, request.drive);
  w.end_object();
  return w.take();
}

std::string write_map_answer(const MapAnswer& answer) {
  const dem::RasterLayer& layer = answer.layer;
  const dem::GridGeometry& g = layer.geometry;
  const dem::Extent extent = g.extent();
  Writer w;
  w.begin_object().text("format", "map/1").text("kind", planner::row_of(answer.request.kind).name);
  w.text("terrain", answer.request.terrain).text("rover", answer.request.rover);
  w.text("description", layer.description).text("unit", layer.unit);
  w.text("crs_name", answer.provenance.crs_name).text("body", answer.provenance.body);
  w.whole("rows", g.rows).whole("columns", g.columns);
  w.exact("cell_x_m", g.cell_x_m).exact("cell_y_m", g.cell_y_m);
  w.key("extent").begin_object().exact("west_m", extent.west_m).exact("south_m", extent.south_m);
  w.exact("east_m", extent.east_m).exact("north_m", extent.north_m).end_object();
  w.text("data_type", layer.of_classes ? "Byte" : "Float32").exact("nodata", layer.nodata);
  w.whole("levels", dem::levels_of(g));
  w.key("statistics").begin_object().whole("cells", answer.statistics.cells);
  w.whole("nodata_cells", answer.statistics.nodata);
  if (!layer.of_classes && answer.statistics.nodata < answer.statistics.cells) {
    w.significant("lowest", answer.statistics.lowest).significant("highest", answer.statistics.highest);
    w.significant("mean", answer.statistics.mean);
  }
  w.end_object();
  if (layer.of_classes) write_classes(w, answer);
  w.key("metadata").begin_object();
  for (const auto& [name, value] : layer.metadata) w.text(name, value);
  w.end_object();
  w.text("style_qml", map_style(layer, answer.statistics));
  w.key("request").raw(write_map_request(answer.request)).end_object();
  return w.take();
}

}  // namespace slipway::api::json
