#include <CLI/CLI.hpp>
#include <memory>

#include "server/cli/data_option.h"
#include "server/cli/steps_command.h"

namespace slipway::server {
namespace {

void add_score(CLI::App& steps, std::function<int()>& run) {
  const auto options = std::make_shared<StepsScoreCommand>();
  CLI::App* const command =
      steps.add_subcommand("score", "predict the slip of every measured step and compare");
  command->add_option("table", options->table, "file of steps (CSV, \"slip-steps/1\")")->required();
  add_data_option(*command, options->data, "rovers, soils and terrains");
  command->add_option("--rover", options->rover, "rover that made the steps")->capture_default_str();
  command->add_option("--terrain", options->terrain, "take slope and soil from this terrain's map");
  command->add_option("--legend", options->legend, "legend of the terrain; its first where not given");
  command
      ->add_option("--learn", options->learn,
                   "what a forecast knows: none, sols (the sols before it) or drive (also the steps before "
                   "it on its sol)")
      ->capture_default_str()
      ->check(CLI::IsMember({"none", "sols", "drive"}));
  command->add_option("--plot", options->plot, "file for a picture of slip over climb (SVG)");
  command->add_flag("--json", options->json, "print every step and the summary as a document, for machines");
  command->footer(
      "Example:\n"
      "  slipway steps score curiosity.csv --learn drive\n"
      "Exit status: 0 compared, 1 the picture could not be written, 2 options or files with faults.");
  command->callback([options, &run] { run = [options] { return steps_score(*options); }; });
}

void add_learn(CLI::App& steps, std::function<int()>& run) {
  const auto options = std::make_shared<StepsLearnCommand>();
  CLI::App* const command =
      steps.add_subcommand("learn", "fit a belief of the ground to measured steps and write it as soils");
  command->add_option("tables", options->tables, "files of steps (CSV, \"slip-steps/1\")")->required();
  add_data_option(*command, options->data, "rovers");
  command->add_option("--rover", options->rover, "rover that made the steps")->capture_default_str();
  command->add_option(
      "--class", options->classes,
      "a class of ground fitted to some steps: NAME=978,538:20-36 (sols, or steps of a sol) or "
      "NAME=unit:SM,SMR (the table's terrain_unit)");
  command->add_option("--out", options->out, "file of the soils (JSON, \"soils/1\")")->required();
  command->footer(
      "Example:\n"
      "  slipway steps learn curiosity.csv --class mars_dune=538:21-36 --out soils.json\n"
      "Exit status: 0 written, 1 given up or not written, 2 options or files with faults.");
  command->callback([options, &run] { run = [options] { return steps_learn(*options); }; });
}

}  // namespace

void add_steps_command(CLI::App& app, std::function<int()>& run) {
  CLI::App* const command =
      app.add_subcommand("steps", "measured slip of a rover, step by step: compare with it, learn from it");
  command->require_subcommand(1);
  add_score(*command, run);
  add_learn(*command, run);
}

}  // namespace slipway::server
