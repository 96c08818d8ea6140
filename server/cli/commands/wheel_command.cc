#include "server/cli/commands/wheel_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <sstream>
#include <vector>

#include "api/documents/soil/wheel_sweep_answer.h"
#include "api/files/terrain_site.h"
#include "api/json/faults.h"
#include "api/json/writer.h"
#include "api/report/sweep_chart.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/exit_status.h"
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

// A number that is stated, and by which flag.
struct Stated {
  std::string parameter, flag;
};

std::string before_equals(const std::string& text) {
  return text.substr(0, text.find('='));
}

void add_conditions(const WheelOptions& options, std::vector<Stated>& stated) {
  const auto add = [&](bool given, const char* parameter, const char* flag) {
    if (given) stated.push_back({parameter, flag});
  };
  add(options.slip.has_value(), "slip", "/slip");
  add(options.slip_angle_deg.has_value(), "slip_angle_deg", "/slip-angle-deg");
  add(options.slope_deg.has_value(), "slope_deg", "/slope");
  add(options.load_n.has_value(), "load_n", "/load");
  add(options.sinkage_m.has_value(), "sinkage_m", "/sinkage-m");
  add(options.speed_m_s.has_value(), "speed_m_s", "/speed-m-s");
  add(options.gravity_m_s2.has_value(), "gravity_m_s2", "/gravity");
  add(options.motor_temp_c.has_value(), "motor_temp_c", "/motor-temp-c");
  add(options.radius_m.has_value(), "wheel.radius_m", "/radius");
  add(options.width_m.has_value(), "wheel.width_m", "/width");
}

// "grousers:height_m=0.01,count=24" states effects.grousers.height_m and effects.grousers.count.
void add_effect(const std::string& text, std::vector<Stated>& stated) {
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  stated.push_back({"effects." + name, "/effect"});
  if (colon == std::string::npos) return;
  std::string_view rest = std::string_view(text).substr(colon + 1);
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view entry = rest.substr(0, comma);
    if (const std::size_t equals = entry.find('='); equals != std::string_view::npos)
      stated.push_back({fmt::format("effects.{}.{}", name, entry.substr(0, equals)), "/effect"});
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
}

// Flags of which one would take another's place without a word: a number that is given by its own flag, by
// --set, by --sweep or --rows, or by an effect more than once, and a slip beside a slope. `rows` are the
// columns of --rows. Pointers are the flags: "/slip", "/set/soil.n", "/effect".
std::vector<Fault> dropped_flags(const WheelOptions& options, const std::vector<sim::SweepAxis>& rows) {
  std::vector<Stated> stated;
  add_conditions(options, stated);
  for (const std::string& effect : options.effects) add_effect(effect, stated);
  for (const std::string& setting : options.set) {
    const std::string name = before_equals(setting);
    stated.push_back({name, "/set/" + name});
  }
  for (const std::string& sweep : options.sweeps) stated.push_back({before_equals(sweep), "/sweep"});
  for (const sim::SweepAxis& axis : rows) stated.push_back({axis.parameter, "/rows"});
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < stated.size(); ++i)
    for (std::size_t k = i + 1; k < stated.size(); ++k)
      // Two axes of one name are the sweep's own fault.
      if (stated[i].parameter == stated[k].parameter && stated[i].flag != "/sweep" &&
          stated[i].flag != "/rows")
        faults.push_back({stated[i].flag, fmt::format("{} is given by {} too, which would take its place",
                                                      stated[i].parameter, stated[k].flag)});
  const auto find = [&](std::string_view parameter) {
    return std::find_if(stated.begin(), stated.end(),
                        [&](const Stated& s) { return s.parameter == parameter; });
  };
  const auto end = stated.end();
  if (const auto slip = find("slip"); slip != end && find("slope_deg") != end)
    faults.push_back({slip->flag, "slip and slope_deg: on a slope the slip follows from the pull"});
  if (const auto load = find("load_n"); load != end && find("sinkage_m") != end)
    faults.push_back(
        {load->flag, "load_n and sinkage_m: a wheel that is held at a depth carries no given load"});
  if (options.whole_rover && !options.rows.empty() && find("slope_deg") == end)
    faults.push_back({"/whole-rover", "the rows have no slope_deg"});
  return faults;
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

namespace {

constexpr const char* kWheelExample =
    "Example: pull, sinkage and current over slip at three slip angles, as table, CSV and picture; the slip "
    "of "
    "a whole rover over slopes\n"
    "  slipway wheel --rover mer-class --soil jlu_mars_2_dense --sweep slip=0:0.9:0.1 --sweep "
    "slip_angle_deg=0,15,30 --csv wheel.csv --plot wheel.svg\n"
    "  slipway wheel --rover mer-class --soil jlu_mars_2_dense --whole-rover --sweep slope_deg=0:20:2\n"
    "Exit status: 0 a table, 2 input that can't be used, 5 a table in which in some row the wheel sank to "
    "its "
    "axle, no slip climbs the slope or the rover does not get up it.\n"
    "What can be swept besides the conditions: soil.n, wheel.width_m, effects.grousers.height_m and more; an "
    "unknown name lists them.";

}  // namespace

void add_wheel_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<WheelOptions>();
  CLI::App* command = app.add_subcommand("wheel", "what a single-wheel test rig would report");
  add_local_ask(*command, options->ask);
  command->add_option("--url", options->ask.url, "ask a running service, http://HOST:PORT");
  command->add_option("--rover", options->rover, "whose wheel and motor it is")->capture_default_str();
  command->add_option("--wheel", options->wheel, "of the rover; otherwise its first");
  command->add_option("--soil", options->soil, "name of the soil")->capture_default_str();
  CLI::Option* const sweep =
      command->add_option("--sweep", options->sweeps, "NAME=from:to:step or NAME=a,b,c; at most two");
  command
      ->add_option(
          "--rows", options->rows,
          "CSV whose first line names parameters that can be swept and whose other lines are one row "
          "of the table each, in the place of --sweep")
      ->excludes(sweep);
  command->add_option("--set", options->set,
                      "NAME=value: anything that can be swept, throughout; a soil that no file has, say");
  command->add_option("--load,--load-n", options->load_n,
                      "on the wheel; otherwise an equal share of the weight");
  command->add_option("--sinkage-m", options->sinkage_m, "hold the wheel at this depth instead");
  CLI::Option* const slip =
      command->add_option("--slip", options->slip, "-1 locked to 1 spinning on the spot");
  command
      ->add_option("--slope", options->slope_deg,
                   "deg: the slip at which the wheel's pull is its load's part along this slope")
      ->excludes(slip);
  command
      ->add_flag("--whole-rover", options->whole_rover,
                 "the whole rover on the slope, each wheel under the load that its lean gives it")
      ->excludes(slip);
  command->add_option(
      "--slip-radius", options->slip_radius,
      "where the rim's speed in a slip is taken: rim, shear (where the soil is sheared) or tip "
      "(of the cleats)");
  command->add_option("--slip-angle-deg", options->slip_angle_deg, "from the wheel's plane to its travel");
  command->add_option("--slip-definition", options->slip_definition,
                      "what slip compares the rim's speed with: forward (along the wheel's plane) or travel");
  command->add_option("--speed-m-s", options->speed_m_s, "that is held; otherwise the rover's cruise speed");
  command->add_option("--speed-of", options->speed_of, "rim or travel: which speed is held");
  command->add_option("--gravity", options->gravity_m_s2, "m/s^2; 3.71 otherwise");
  command->add_option("--radius", options->radius_m, "of the rim, m");
  command->add_option("--width", options->width_m, "of the rim, m");
  command->add_option("--grousers", options->grousers, "height in m and count: 0.01,24");
  command->add_option("--motor-temp-c", options->motor_temp_c, "of the motor");
  command->add_flag("--in-a-track", options->in_a_track, "of an earlier wheel, with the effect multipass");
  command->add_option("--effect", options->effects, "switch an effect on: NAME or NAME:parameter=value,...");
  command->add_option("--csv", options->csv, "write the rows to this file");
  command->add_option("--plot", options->plot, "write a picture (SVG) to this file");
  command->footer(kWheelExample);
  command->callback([options, &run] { run = [options] { return wheel(*options); }; });
}

}  // namespace slipway::server
