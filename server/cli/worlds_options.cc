#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>

#include "core/largest_exact_whole.h"
#include "server/cli/data_option.h"
#include "server/cli/worlds_command.h"

namespace slipway::server {

void add_worlds_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<WorldsCommand>();
  validation::WorldStudyOptions& study = options->study;
  CLI::App* command = app.add_subcommand(
      "worlds",
      "plan in made worlds whose truth is known, drive there, and compare planners and predictions");
  add_data_option(*command, options->data, "rovers");
  command->add_option("--rover", options->rover, "name of a rover")->capture_default_str();
  const auto add_number = [&](const char* flag, int& value, int lowest, int highest, const char* words) {
    return command->add_option(flag, value, words)->capture_default_str()->check(CLI::Range(lowest, highest));
  };
  CLI::Option* const seed =
      command->add_option("--seed", study.seed, "of the first world; the others have the numbers after it")
          ->capture_default_str()
          ->check(CLI::Range(std::uint64_t{0}, kMaxExactWhole / 2));
  CLI::Option* const count = add_number("--worlds", study.worlds, 1, 100'000, "number of worlds");
  CLI::Option* const drives =
      add_number("--drives", study.drives, 1, 10'000, "executions of each route on each kind of truth");
  add_number("--threads", options->threads, 0, 1024, "worlds at once; 0: as many as the machine has");
  CLI::Option* const scores = command->add_option(
      "--scores", options->scores, "count the scores of this file, which --csv wrote, in place of a study");
  for (CLI::Option* const other : {seed, count, drives}) scores->excludes(other);
  command->add_option("--csv", options->csv, "file for the scores, one line a route and kind of truth");
  command->add_option("--plots", options->plots, "folder for the reliability diagrams");
  CLI::Option* const check = command->add_option("--check", options->check,
                                                 "also fail where this page does not hold what is printed");
  command->add_option("--write", options->write, "put what is printed into this page")->excludes(check);
  command->footer(
      "Example: the study of docs/results/worlds.md in worlds that nobody has seen\n"
      "  slipway worlds --seed 5001 --worlds 40 --csv scores.csv\n"
      "Exit status: 0 done, 1 interrupted or another page than printed, 2 options or files with faults.");
  command->callback([options, &run] { run = [options] { return worlds(*options); }; });
}

}  // namespace slipway::server
