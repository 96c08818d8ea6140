#include "api/documents/soil/wheel_sweep_answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "api/documents/rover_slope_rows.h"
#include "api/documents/soil/wheel_sweep_request.h"
#include "api/json/parse.h"
#include "api/json/writer.h"
#include "core/angle.h"

namespace slipway::api::json {
namespace {

struct Column {
  std::string_view name, unit, summary;
  // Nothing where the row has no such value.
  std::optional<double> (*value)(const sim::SweepRow& row);
};

using Row = sim::SweepRow;
using Value = std::optional<double>;

constexpr std::array kColumns{
    Column{"slip", "1", "of the wheel, by the request's slip_definition",
           [](const Row& r) -> Value { return r.result.slip; }},
    Column{"slip_angle_deg", "deg", "from the wheel's plane to its travel, positive to the left",
           [](const Row& r) -> Value { return deg_from_rad(r.point.test.slip_angle_rad); }},
    Column{"load_n", "N", "that the wheel must carry; none where it is held at a depth",
           [](const Row& r) -> Value {
             return r.point.test.sinkage_m ? std::nullopt : Value(r.point.test.load_n);
           }},
    Column{"entry_angle_deg", "deg", "where the rim meets the soil, from straight down",
           [](const Row& r) -> Value { return deg_from_rad(r.result.entry_angle_rad); }},
    Column{"exit_angle_deg", "deg", "where it leaves it, negative behind",
           [](const Row& r) -> Value { return deg_from_rad(r.result.exit_angle_rad); }},
    Column{"sinkage_m", "m", "of the rim's lowest point",
           [](const Row& r) -> Value { return r.result.sinkage_m; }},
    Column{"drawbar_pull_n", "N", "thrust less resistances, along the wheel's plane",
           [](const Row& r) -> Value { return r.result.forces.drawbar_pull_n; }},
    Column{"lateral_force_n", "N", "of the soil on the wheel, positive to the left",
           [](const Row& r) -> Value { return r.result.forces.lateral_n; }},
    Column{"vertical_force_n", "N", "of the soil on the wheel, up",
           [](const Row& r) -> Value { return r.result.forces.vertical_n; }},
    Column{"torque_nm", "N m", "at the axle, positive drives forward",
           [](const Row& r) -> Value { return r.result.forces.torque_nm; }},
    Column{"current_a", "A", "of the rover's drive motor",
           [](const Row& r) -> Value { return r.result.current_a; }},
    Column{"thrust_n", "N", "of shear and grousers", [](const Row& r) -> Value { return r.result.thrust_n; }},
    Column{"compaction_resistance_n", "N", "of the normal stress",
           [](const Row& r) -> Value { return r.result.compaction_resistance_n; }},
    Column{"bulldozing_resistance_n", "N", "of the soil pushed ahead",
           [](const Row& r) -> Value { return r.result.bulldozing_resistance_n; }},
    Column{"tractive_efficiency", "1",
           "pull times forward speed over torque times rate, where it drives and pulls",
           [](const Row& r) -> Value { return r.result.tractive_efficiency; }},
};
constexpr std::size_t kGivenColumns = 3;  // slip, slip angle, load: said of a sunk wheel too

bool is_column(std::string_view name) {
  return std::any_of(kColumns.begin(), kColumns.end(), [&](const Column& c) { return c.name == name; });
}

void write_column(Writer& w, std::string_view name, std::string_view unit, std::string_view summary) {
  w.begin_object().text("name", name).text("unit", unit).text("summary", summary).end_object();
}

void write_columns(Writer& w, const sim::WheelSweep& sweep) {
  w.key("columns").begin_array();
  for (const sim::SweepAxis& axis : sweep.axes) {
    if (is_column(axis.parameter)) continue;
    const auto field = sim::sweep_field(axis.parameter, *sweep.rig.soil_format);
    write_column(w, axis.parameter, field ? field->unit : "", field ? field->summary : "");
  }
  for (const Column& column : kColumns) write_column(w, column.name, column.unit, column.summary);
  write_column(w, "outcome", "",
               "balanced, held (at the given depth), sunk_to_axle, immobilised (on a slope) or not_balanced");
  write_column(w, "reason", "", "why there are no forces");
  w.end_array();
}

void write_row(Writer& w, const sim::WheelSweep& sweep, const Row& row) {
  w.begin_object();
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    if (!is_column(sweep.axes[a].parameter)) w.exact(sweep.axes[a].parameter, row.point.at[a]);
  }
  for (std::size_t c = 0; c < kColumns.size(); ++c) {
    if (c >= kGivenColumns && !row.result.stands()) break;
    if (const Value value = kColumns[c].value(row)) w.significant(kColumns[c].name, *value);
  }
  w.text("outcome", sim::describe(row.result.outcome));
  if (!row.result.reason.empty()) w.text("reason", row.result.reason);
  w.end_object();
}

}  // namespace

std::string write_wheel_sweep_answer(const WheelSweepAnswer& answer) {
  Writer w;
  w.begin_object().text("format", "wheel_sweep/1");
  w.key("request").raw(write_wheel_sweep_request(answer.request));
  if (answer.request.whole_rover) {
    write_rover_columns(w, answer);
    write_rover_rows(w, answer);
  } else {
    write_columns(w, answer.sweep);
    w.key("rows").begin_array();
    for (const Row& row : answer.rows) write_row(w, answer.sweep, row);
    w.end_array();
  }
  w.end_object();
  return w.take();
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

Result<std::string> wheel_sweep_csv(std::string_view document) {
  const auto parsed = parse(document, {.bytes = document.size(), .values = document.size()});
  if (!parsed) return fail(parsed.error());
  const JsonValue* const columns = parsed->find("columns");
  const JsonValue* const rows = parsed->find("rows");
  if (columns == nullptr || rows == nullptr)
    return fail(ErrorCode::kInternal, "the answer has no columns or no rows");
  std::string csv;
  for (const JsonValue& column : columns->elements)
    csv += (csv.empty() ? "" : ",") + csv_field(column.find("name")->text);
  csv += "\n";
  for (const JsonValue& row : rows->elements) {
    std::string line;
    for (std::size_t c = 0; c < columns->elements.size(); ++c) {
      const JsonValue* const cell = row.find(columns->elements[c].find("name")->text);
      if (c > 0) line += ",";
      if (cell != nullptr)
        line += cell->is(JsonValue::Kind::kNumber) ? fmt::format("{}", cell->number) : csv_field(cell->text);
    }
    csv += line + "\n";
  }
  return csv;
}

}  // namespace slipway::api::json
