#include <CLI/CLI.hpp>
#include <memory>

#include "server/cli/current_command.h"

namespace slipway::server {
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
