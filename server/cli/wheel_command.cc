#include "server/cli/wheel_command.h"

#include <vector>

#include "api/documents/wheel_sweep_answer.h"
#include "api/json/writer.h"
#include "api/report/sweep_chart.h"
#include "server/cli/command_parts.h"
#include "server/cli/terminal/tables.h"

namespace slipway::server {
namespace {

using api::json::Writer;

void write_if(Writer& w, std::string_view key, const std::optional<double>& value) {
  if (value) w.exact(key, *value);
}
void write_if(Writer& w, std::string_view key, const std::string& value) {
  if (!value.empty()) w.text(key, value);
}

std::string request_of(const WheelOptions& options) {
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
  write_if(w, "slip_angle_deg", options.slip_angle_deg);
  write_if(w, "slip_definition", options.slip_definition);
  write_if(w, "speed_m_s", options.speed_m_s);
  write_if(w, "speed_of", options.speed_of);
  write_if(w, "motor_temp_c", options.motor_temp_c);
  if (options.in_a_track) w.boolean("in_a_track", true);
  w.key("effects").begin_array();
  for (const std::string& effect : options.effects) write_effect(w, effect);
  w.end_array().key("set").begin_object();
  for (const std::string& setting : options.set) write_setting(w, setting);
  w.end_object().key("sweep").begin_array();
  for (const std::string& sweep : options.sweeps) write_sweep_axis(w, sweep);
  w.end_array().end_object();
  return w.take();
}

}  // namespace

int wheel(const WheelOptions& options) {
  const auto service = inquiry(options.ask);
  if (!service) return refuse(service.error());
  const auto answer = (*service)->wheel_sweep(request_of(options));
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
  return deliver(files, *printed + (options.ask.json ? "\n" : ""));
}

}  // namespace slipway::server
