#include <CLI/CLI.hpp>
#include <memory>

#include "server/cli/wheel_command.h"

namespace slipway::server {
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
