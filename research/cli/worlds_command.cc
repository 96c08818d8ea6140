#include "research/cli/worlds_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <utility>
#include <vector>

#include "api/files/whole_file.h"
#include "core/largest_exact_whole.h"
#include "research/cli/validate_command.h"
#include "research/validation/worlds/comparisons.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_option.h"

namespace slipway::server {
namespace {

using validation::Report;
using validation::WorldScore;

Result<std::vector<WorldScore>> studied(const WorldsCommand& options) {
  const auto catalogue = open_catalogue(options.data);
  if (!catalogue) return fail(catalogue.error());
  const auto rover = catalogue->rovers.find(options.rover);
  if (rover == catalogue->rovers.end())
    return fail(ErrorCode::kInvalidRequest, "an unknown rover was asked for",
                {{"/rover", fmt::format("the data folder has no rover {}", options.rover)}});
  validation::WorldStudyOptions study = options.study;
  study.threads = static_cast<std::size_t>(options.threads);
  const auto tell = [&](int done) { std::cerr << fmt::format("[{}/{}] worlds\n", done, study.worlds); };
  return validation::study_worlds(study, rover->second, tell, Interruptible());
}

Result<void> write_plots(const std::string& folder, const Report& report) {
  if (folder.empty()) return {};
  if (const auto made = api::make_folder(folder); !made) return made;
  return api::write_whole_file(std::filesystem::path(folder) / "worlds_reliability.svg", report.plot);
}

}  // namespace

int worlds(const WorldsCommand& options) {
  const auto scores =
      options.scores.empty() ? studied(options) : validation::read_world_scores(options.scores);
  if (!scores) return refuse(scores.error());
  const Report reliability = validation::reliability_report(*scores);
  const std::string printed = validation::planners_report(*scores).markdown() +
                              validation::slip_report(*scores).markdown() + reliability.markdown();
  if (const auto written = write_plots(options.plots, reliability); !written) return refuse(written.error());
  const auto page = settle_page(options.write, options.check, printed, "slipway worlds --scores ...");
  std::vector<OutputFile> files;
  if (!options.csv.empty()) files.push_back({options.csv, validation::csv_of(*scores)});
  const int status = deliver(files, printed);
  if (!page) return refuse(page.error());
  return *page ? status : 1;
}

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
