#include "server/cli/commands/current_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <vector>

#include "api/documents/soil/current_documents.h"
#include "api/report/current_maps_output.h"
#include "api/requests/current_inversion.h"
#include "api/requests/current_maps.h"
#include "api/service.h"
#include "core/angle.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_folder.h"

namespace slipway::server {
namespace {

constexpr std::size_t kSamplesAlongX = 61, kLinesOverY = 5;

Result<api::CurrentMaps> maps_of(const api::Catalogue& catalogue, const CurrentMapCommand& command) {
  api::CurrentMapOptions options;
  options.rover = command.rover;
  options.load_n = command.load_n;
  options.gravity_m_s2 = command.gravity_m_s2;
  options.slip = command.slip;
  options.model = command.model == "balanced" ? sim::CurrentModel::kBalanced : sim::CurrentModel::kLiteral;
  if (command.figure) return api::current_figure(catalogue, options, *command.figure);
  std::vector<sim::SweepAxis> axes;
  const auto x = sweep_axis_of(command.x, kSamplesAlongX, "x");
  if (!x) return fail(x.error());
  axes.push_back(*x);
  if (!command.y.empty()) {
    const auto y = sweep_axis_of(command.y, kLinesOverY, "y");
    if (!y) return fail(y.error());
    axes.push_back(*y);
  }
  return api::current_map(catalogue, options, command.soil, axes);
}

std::string words_of(const api::CurrentInversion& inversion) {
  const sim::CurrentInverse& answer = inversion.answer;
  const api::CurrentInversionRequest& request = inversion.request;
  std::string out =
      fmt::format("{:.3f} A of wheel {} of {} under {:.1f} N on {}: {}\n", request.current_a, request.wheel,
                  request.rover, request.load_n.value_or(0.0), request.soil, sim::describe(answer.verdict));
  for (const std::string& reason : answer.words) out += fmt::format("  - {}\n", reason);
  if (answer.found.reported) out += fmt::format("slip               {:.3f}", *answer.found.reported);
  if (const sim::SlipQuantiles& q = answer.quantiles; answer.found.reported && q.solved > 0)
    out += fmt::format(
        "   (5, 50, 95 % of {} soil draws: {:.3f}, {:.3f}, {:.3f}; {} draws ask for less current "
        "at any slip, {} for more)",
        q.draws, q.p05, q.p50, q.p95, q.above, q.below);
  if (answer.found.reported) out += "\n";
  if (answer.wheel)
    out += fmt::format("sinkage            {:.1f} mm\ndrawbar pull       {:.1f} N\n",
                       1e3 * answer.wheel->sinkage_m, answer.wheel->forces.drawbar_pull_n);
  if (answer.greatest)
    out += fmt::format("greatest pull      {:.1f} N at slip {:.2f}\n", answer.greatest->pull_n,
                       answer.greatest->slip);
  if (answer.share_of_pull)
    out += fmt::format("pull in use        {:.0f} %\n", 100.0 * *answer.share_of_pull);
  if (answer.slope_in_use_rad)
    out += fmt::format("slope              {:.1f} deg in use, {:.1f} deg at most, {:.1f} deg left\n",
                       deg_from_rad(*answer.slope_in_use_rad), deg_from_rad(*answer.slope_greatest_rad),
                       deg_from_rad(*answer.slope_left_rad));
  return out;
}

}  // namespace

int current_map(const CurrentMapCommand& options) {
  const auto catalogue = open_catalogue(options.ask.data);
  if (!catalogue) return refuse(catalogue.error());
  const auto maps = maps_of(*catalogue, options);
  if (!maps) return refuse(maps.error());
  const std::string csv = api::current_maps_csv(*maps);
  std::vector<OutputFile> files;
  if (!options.csv.empty()) files.push_back({options.csv, csv});
  if (!options.plot.empty()) files.push_back({options.plot, api::draw_current_maps(*maps)});
  std::string printed;
  if (options.ask.json) {
    printed = api::json::write_current_maps(*maps) + "\n";
  } else if (options.csv.empty()) {
    printed = csv;
  }
  return deliver(files, printed);
}

int current_invert(const CurrentInvertCommand& options) {
  const auto data = data_folder(options.ask.data);
  if (!data) return refuse(data.error());
  const auto service = api::Service::open({.data = *data});
  if (!service) return refuse(service.error());
  api::CurrentInversionRequest request;
  request.rover = options.rover;
  request.wheel = options.wheel;
  request.soil = options.soil;
  request.current_a = options.current_a;
  request.load_n = options.load_n;
  request.gravity_m_s2 = options.gravity_m_s2;
  request.speed_m_s = options.speed_m_s;
  request.motor_temp_c = options.motor_temp_c;
  for (const std::string& setting : options.effects) {
    const auto effect = effect_of(setting);
    if (!effect) return refuse(effect.error());
    request.effects.push_back(*effect);
  }
  request.options.max_slip = options.max_slip;
  request.options.draws = options.draws;
  request.options.seed = options.seed;
  const auto inversion = api::invert_current(*(*service)->catalogue(), request);
  if (!inversion) return refuse(inversion.error());
  return deliver(
      {}, options.ask.json ? api::json::write_current_inversion(*inversion) + "\n" : words_of(*inversion));
}

namespace {

constexpr const char* kMapExample =
    "Example: figure 10 of the Zhurong paper, and a map of one's own\n"
    "  slipway current map --figure 10 --csv figure10.csv --plot figure10.svg\n"
    "  slipway current map --soil jlu_mars_3_loose --x k_s --y slip=0.1,0.5,0.9 --model balanced";
constexpr const char* kInvertExample =
    "Example: which slip does a wheel have that draws 0.7 A?\n"
    "  slipway current invert --rover zhurong-class --soil jlu_mars_2_dense --current 0.7 --gravity 9.81";

void add_map(CLI::App& current, std::function<int()>& run) {
  const auto options = std::make_shared<CurrentMapCommand>();
  CLI::App* command = current.add_subcommand("map", "current over soil parameters and slip, figures 9 to 11");
  add_local_ask(*command, options->ask);
  CLI::Option* const figure = command->add_option(
      "--figure", options->figure, "9, 10 or 11 of the Zhurong paper: all its panels, on the paper's soils");
  command->add_option("--soil", options->soil, "soil of one's own map")->capture_default_str();
  command->add_option("--x", options->x,
                      "what varies along x: slip, k_s, n, cohesion_pa, friction_angle_deg over "
                      "the paper's range, or NAME=from:to:step, NAME=a,b,c");
  command->add_option("--y", options->y, "the same for the lines; with more than seven values a heat map");
  command->add_option("--rover", options->rover, "whose first wheel it is")->capture_default_str();
  command->add_option("--slip", options->slip, "where no axis is slip")->capture_default_str();
  command->add_option("--load,--load-n", options->load_n,
                      "on the wheel; otherwise an equal share of the weight");
  command->add_option("--gravity", options->gravity_m_s2, "m/s^2")->capture_default_str();
  command
      ->add_option(
          "--model", options->model,
          "literal: entry angle by the paper's A18, current by the gear that its 0.114 A implies; balanced: "
          "the soil carries the load, current by the rover's motor")
      ->capture_default_str()
      ->check(CLI::IsMember({"literal", "balanced"}));
  for (const char* of_an_own_map : {"--soil", "--x", "--y"})
    figure->excludes(command->get_option(of_an_own_map));
  command->add_option("--csv", options->csv, "write the points to this file instead of printing them");
  command->add_option("--plot", options->plot, "write a picture (SVG) to this file");
  command->footer(kMapExample);
  command->callback([options, &run] { run = [options] { return current_map(*options); }; });
}

void add_invert(CLI::App& current, std::function<int()>& run) {
  const auto options = std::make_shared<CurrentInvertCommand>();
  CLI::App* command =
      current.add_subcommand("invert", "slip, pull in use and slope left from a measured current");
  add_local_ask(*command, options->ask);
  command->add_option("--rover", options->rover, "name of the rover")->capture_default_str();
  command->add_option("--wheel", options->wheel, "of the rover; otherwise its first");
  command->add_option("--soil", options->soil, "name of the soil")->capture_default_str();
  command->add_option("--current,--current-a", options->current_a, "measured, A")->required();
  command->add_option("--load,--load-n", options->load_n,
                      "on the wheel; otherwise an equal share of the weight");
  command->add_option("--gravity", options->gravity_m_s2, "m/s^2")->capture_default_str();
  command->add_option("--speed-m-s", options->speed_m_s, "of the rim; otherwise the rover's cruise speed");
  command->add_option("--motor-temp-c", options->motor_temp_c, "of the motor");
  command->add_option("--effect", options->effects, "switch an effect on: NAME or NAME:parameter=value,...");
  command->add_option("--max-slip", options->max_slip, "limit between GO and NO-GO")->capture_default_str();
  command->add_option("--draws", options->draws, "of the soil, for the spread")->capture_default_str();
  command->add_option("--seed", options->seed, "the same seed gives the same answer")->capture_default_str();
  command->footer(kInvertExample);
  command->callback([options, &run] { run = [options] { return current_invert(*options); }; });
}

}  // namespace

void add_current_command(CLI::App& app, std::function<int()>& run) {
  CLI::App* command = app.add_subcommand("current", "the drive current's model: maps of it, and its inverse");
  command->require_subcommand(1);
  command->footer(kMapExample);
  add_map(*command, run);
  add_invert(*command, run);
}

}  // namespace slipway::server
