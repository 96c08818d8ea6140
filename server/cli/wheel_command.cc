#include "server/cli/wheel_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <vector>

#include "api/documents/wheel_sweep_answer.h"
#include "api/files/terrain_site.h"
#include "api/json/faults.h"
#include "api/json/writer.h"
#include "api/report/sweep_chart.h"
#include "server/cli/command_parts.h"
#include "server/cli/exit_status.h"
#include "server/cli/terminal/tables.h"
#include "server/cli/wheel_faults.h"

namespace slipway::server {
namespace {

using api::json::Writer;

void write_if(Writer& w, std::string_view key, const std::optional<double>& value) {
  if (value) w.exact(key, *value);
}
void write_if(Writer& w, std::string_view key, const std::string& value) {
  if (!value.empty()) w.text(key, value);
}

std::string request_of(const WheelOptions& options, const std::vector<sim::SweepAxis>& rows) {
  Writer w;
  w.begin_object().text("rover", options.rover).text("soil", options.soil);
  write_if(w, "wheel", options.wheel);
  write_if(w, "radius_m", options.radius_m);
  write_if(w, "width_m", options.width_m);
  if (!options.grousers.empty()) write_grousers(w.key("grousers"), options.grousers);
  write_if(w, "gravity_m_s2", options.gravity_m_s2);
  write_if(w, "load_n", options.load_n);
  write_if(w, "sinkage_m", options.sinkage_m);
  write_if(w, "slip", options.slip);
  write_if(w, "slope_deg", options.slope_deg);
  write_if(w, "slip_angle_deg", options.slip_angle_deg);
  write_if(w, "slip_definition", options.slip_definition);
  write_if(w, "slip_radius", options.slip_radius);
  write_if(w, "speed_m_s", options.speed_m_s);
  write_if(w, "speed_of", options.speed_of);
  write_if(w, "motor_temp_c", options.motor_temp_c);
  if (options.in_a_track) w.boolean("in_a_track", true);
  if (options.whole_rover) w.boolean("whole_rover", true);
  w.key("effects").begin_array();
  for (const std::string& effect : options.effects) write_effect(w, effect);
  w.end_array().key("set").begin_object();
  for (const std::string& setting : options.set) write_setting(w, setting);
  w.end_object();
  if (!rows.empty()) w.boolean("paired", true);
  w.key("sweep").begin_array();
  for (const std::string& sweep : options.sweeps) write_sweep_axis(w, sweep);
  for (const sim::SweepAxis& axis : rows) {
    w.begin_object().text("parameter", axis.parameter).key("values").begin_array();
    for (const double value : axis.values) w.exact(value);
    w.end_array().end_object();
  }
  w.end_array().end_object();
  return w.take();
}

// The columns of a CSV file of rows, each a parameter with one value a row. Errors: unreadable_data with
// every fault.
Result<std::vector<sim::SweepAxis>> read_rows(const std::string& path) {
  const auto bytes = api::read_data_file(path);
  if (!bytes) return fail(bytes.error());
  std::istringstream lines(*bytes);
  std::string line, cell;
  std::vector<sim::SweepAxis> axes;
  std::vector<Fault> faults;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    std::istringstream cells(line);
    std::size_t column = 0;
    for (; std::getline(cells, cell, ','); ++column) {
      if (number == 1) {
        axes.push_back({cell, {}});
        continue;
      }
      double value = 0.0;
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
        faults.push_back(
            {fmt::format("/{}/{}", number, column + 1), fmt::format("\"{:.40}\" is no number", cell)});
      if (column < axes.size()) axes[column].values.push_back(value);
    }
    if (column != axes.size())
      faults.push_back(
          {fmt::format("/{}", number), fmt::format("{} cells, the first line has {}", column, axes.size())});
  }
  if (axes.empty() || axes.front().values.empty())
    faults.push_back({"/1", "no rows: the first line names parameters, each other line has a value of each"});
  if (!faults.empty())
    return fail(ErrorCode::kUnreadableData, "rows that can't be read: " + path, std::move(faults));
  return axes;
}

// Whether the wheel has no place to stand in some row of the answer, or the rover does not climb.
bool sunk_somewhere(std::string_view answer) {
  constexpr std::array<std::string_view, 4> kStuck{"sunk_to_axle", "immobilised", "stalled", "wheel_lifted"};
  return std::any_of(kStuck.begin(), kStuck.end(), [&](std::string_view outcome) {
    return answer.find(fmt::format("\"outcome\":\"{}\"", outcome)) != std::string_view::npos;
  });
}

}  // namespace

int wheel(const WheelOptions& options) {
  std::vector<sim::SweepAxis> rows;
  if (!options.rows.empty()) {
    auto read = read_rows(options.rows);
    if (!read) return refuse_unreadable(read.error());
    rows = std::move(*read);
  }
  if (std::vector<Fault> faults = dropped_flags(options, rows); !faults.empty())
    return refuse({ErrorCode::kInvalidRequest, api::summary_of(faults), faults});
  const auto service = inquiry(options.ask);
  if (!service) return refuse(service.error());
  const auto answer = (*service)->wheel_sweep(request_of(options, rows));
  if (!answer) return refuse(answer.error());
  const auto printed = options.ask.json ? answer : wheel_table(*answer);
  if (!printed) return refuse(printed.error());
  std::vector<OutputFile> files;
  if (!options.csv.empty()) {
    const auto csv = api::json::wheel_sweep_csv(*answer);
    if (!csv) return refuse(csv.error());
    files.push_back({options.csv, *csv});
  }
  if (!options.plot.empty()) {
    const auto picture = api::draw_wheel_sweep(*answer);
    if (!picture) return refuse(picture.error());
    files.push_back({options.plot, *picture});
  }
  const int delivered = deliver(files, *printed + (options.ask.json ? "\n" : ""));
  return delivered == kDone && sunk_somewhere(*answer) ? kSunk : delivered;
}

}  // namespace slipway::server
