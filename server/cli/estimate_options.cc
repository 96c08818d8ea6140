#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>

#include "core/largest_exact_whole.h"
#include "server/cli/belief_command.h"
#include "server/cli/data_option.h"
#include "server/cli/estimate_command.h"

namespace slipway::server {
namespace {

constexpr const char* kExample =
    "Example: the soil under a wheel on a rig; that under plates; that of drives, from currents alone\n"
    "  slipway estimate wheel tests.csv --wheel-radius 0.125 --wheel-width 0.16 --soil unknown_ground\n"
    "  slipway estimate wheel bare.csv lugged.csv --wheel-radius 0.157 --wheel-width 0.165 --grousers "
    "0.01,30@lugged --free n,c1,c2,smooth_rim.friction_share@bare\n"
    "  slipway estimate plates plates.csv --free k_c,k_phi,n --soil-out soils/found.json\n"
    "  slipway estimate drives data/gap-practice/p01 --channels current\n"
    "  slipway estimate belief data/beliefs/wheel_tests_plain.json\n"
    "Exit status: 0 an estimate, whatever it determines, 1 none, 2 input that can't be read, with every "
    "fault.";

using From = EstimateCommand::From;

void add_of_tests(CLI::App& command, EstimateCommand& options) {
  command
      .add_option("--soil", options.soils,
                  "that the search starts from and that priors lie around, unknown_ground otherwise; "
                  "LABEL=NAME of a soil that tests name")
      ->allow_extra_args(false);
  command
      .add_option("--free", options.free,
                  "what is estimated: k_bekker, or k_c,k_phi; n, cohesion, friction_angle, shear_modulus; of "
                  "wheels any other number of a soil's file (c1, n1, dig_rim_share), of an effect "
                  "(smooth_rim.friction_share) or of the wheel (wheel.radius_m); NAME@LABEL of one wheel or "
                  "soil that tests name, otherwise shared by all")
      ->delimiter(',');
  command.add_flag("--merge-stiffness", options.merge_stiffness, "k_bekker in the place of k_c and k_phi");
  command.add_option("--bound", options.bounds, "NAME=lowest:highest, angles in degrees; may be repeated");
  command
      .add_option("--prior", options.priors,
                  "around the soil: wide (what soils of all kinds have), soil (its own spread), none")
      ->capture_default_str()
      ->check(CLI::IsMember({"none", "wide", "soil"}));
  command.add_option("--loss", options.loss, "what outliers cost")
      ->capture_default_str()
      ->check(CLI::IsMember({"none", "huber", "cauchy"}));
  command.add_option("--loss-scale", options.loss_scale, "in deviations, where outliers begin");
  command.add_option("--noise", options.noise, "of readings without a deviation of their own, as a share")
      ->capture_default_str()
      ->check(CLI::Range(1e-4, 1.0));
  command.add_flag("--no-profile", options.no_profile,
                   "intervals from the curvature at the estimate, not by profile likelihood");
  command.add_option("--seed", options.seed, "the same seed gives the same answer")
      ->capture_default_str()
      ->check(CLI::Range(std::uint64_t{0}, kMaxExactWhole));
  command.add_option("--plot", options.plot, "write measured against fitted (SVG) to this file");
}

void add_of_wheels(CLI::App& command, EstimateCommand& options) {
  CLI::Option* const rover = command.add_option("--rover", options.rover,
                                                "whose wheel and motor were tested; its effects are at work");
  command.add_option("--wheel", options.wheel, "of the rover; otherwise its first")->needs(rover);
  // One value each time, so that a file may follow.
  command
      .add_option("--wheel-radius", options.radii, "of the rim, m; 0.125@LABEL of a wheel that tests name")
      ->allow_extra_args(false);
  command.add_option("--wheel-width", options.widths, "of the rim, m; likewise")->allow_extra_args(false);
  command
      .add_option("--grousers", options.grousers, "height in m and count: 0.01,24; 0.01,24@LABEL likewise")
      ->allow_extra_args(false);
  command.add_option(
      "--effect", options.effects,
      "switch an effect on: NAME or NAME:parameter=value,...; NAME@LABEL on one wheel or soil");
  command.add_option("--set", options.set,
                     "NAME=value: anything that can be free, at another value than the soil's; where it is "
                     "free too, the search starts there; NAME@LABEL=value of one wheel or soil");
  command.add_option("--gravity", options.gravity_m_s2, "m/s^2; read by effects and grousers alone")
      ->capture_default_str();
  command.add_option("--speed-m-s", options.speed_m_s, "of the rim, for the motor")->capture_default_str();
  command.add_option("--motor-temp-c", options.motor_temp_c, "of the rover's motor")->needs(rover);
  command
      .add_option("--slip-definition", options.slip_definition,
                  "what slip compares the rim's speed with: forward (along the wheel's plane) or travel")
      ->capture_default_str()
      ->check(CLI::IsMember({"forward", "travel"}));
  command
      .add_option("--slip-radius", options.slip_radius,
                  "where the rim's speed in a slip is taken: rim, shear (where the soil is sheared) or tip")
      ->capture_default_str()
      ->check(CLI::IsMember({"rim", "shear", "tip"}));
}

std::shared_ptr<EstimateCommand> add(CLI::App& parent, const char* name, const char* about, const char* input,
                                     From from, CLI::App*& command, std::function<int()>& run) {
  const auto options = std::make_shared<EstimateCommand>();
  options->from = from;
  command = parent.add_subcommand(name, about);
  if (from == From::kDrives)
    command
        ->add_option_function<std::string>(
            "input", [options](const std::string& folder) { options->files = {folder}; }, input)
        ->required();
  else
    command->add_option("input", options->files, input)->required();
  add_data_option(*command, options->ask.data, "rovers and soils");
  command->add_flag("--json", options->ask.json, "print the whole document, for machines");
  command->add_option("--channels", options->channels, "what is read of what was measured; otherwise all")
      ->delimiter(',');
  command->add_option("--soil-out", options->soil_out,
                      "file for the estimated soil: put into a data folder's soils it is planned with");
  command->footer(kExample);
  command->callback([options, &run] { run = [options] { return estimate(*options); }; });
  return options;
}

void add_belief(CLI::App& parent, std::function<int()>& run) {
  const auto options = std::make_shared<BeliefCommand>();
  CLI::App* command =
      parent.add_subcommand("belief", "what differs between soils, from the wheel tests of several");
  command
      ->add_option("input", options->file,
                   "file \"soil-belief/1\": the soils' tests, what is free in each, and what is between them")
      ->required();
  add_data_option(*command, options->ask.data, "soils and tables of tests");
  command->add_flag("--json", options->ask.json, "print the whole document, for machines");
  command->footer(kExample);
  command->callback([options, &run] { run = [options] { return believe(*options); }; });
}

}  // namespace

void add_estimate_command(CLI::App& app, std::function<int()>& run) {
  CLI::App* parent =
      app.add_subcommand("estimate", "the soil that wheel tests, plate tests or drives show, and how surely");
  parent->require_subcommand(1);
  parent->footer(kExample);
  CLI::App* command = nullptr;
  auto options = add(*parent, "wheel", "from tests of a single wheel",
                     "CSV: load_n, slip_ratio, and of torque_nm, drawbar_pull_n, thrust_n, sinkage_m, "
                     "current_a, lateral_force_n what was measured; columns wheel and soil name what was "
                     "tested, and of several files each is of the wheel that it is named after",
                     From::kWheel, command, run);
  add_of_wheels(*command, *options);
  add_of_tests(*command, *options);
  options = add(*parent, "plates", "from plates pressed into the soil",
                "CSV: plate_radius_m, sinkage_m, pressure_pa or force_n", From::kPlates, command, run);
  add_of_tests(*command, *options);
  options = add(*parent, "drives", "from recorded drives, around the campaign's own soils",
                "folder of a drive campaign", From::kDrives, command, run);
  command->add_option("--threads", options->threads, "at once; 0: as many as the machine has")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  add_belief(*parent, run);
}

}  // namespace slipway::server
