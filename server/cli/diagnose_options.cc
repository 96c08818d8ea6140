#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>

#include "core/largest_exact_whole.h"
#include "gap/diagnosis/drive_watch.h"
#include "server/cli/data_option.h"
#include "server/cli/diagnose_command.h"
#include "server/cli/watch_command.h"

namespace slipway::server {

namespace {

// What both have: how the search is run, and how its answer is printed.
template <class Command>
void add_search(CLI::App& command, Command& options) {
  command.add_option("--seed", options.seed, "the same seed gives the same answer")
      ->capture_default_str()
      ->check(CLI::Range(std::uint64_t{0}, kMaxExactWhole));
  command.add_option("--threads", options.threads, "at once; 0: as many as the machine has")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  command.add_flag("--json", options.json, "print the document, for machines");
}

}  // namespace

void add_diagnose_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<DiagnoseCommand>();
  CLI::App* command = app.add_subcommand(
      "diagnose",
      "where prediction and recorded drives part, which effect is missing, how far the gap closes");
  command->add_option("campaign", options->campaign, "folder of a drive campaign")->required();
  add_data_option(*command, options->data, "rovers and soils");
  command->add_option(
      "--reference", options->reference,
      "folder of drives of the same rover that are taken as healthy: the question is then what "
      "has changed since");
  command->add_option("--without", options->without, "an effect that is not looked for, see slipway effects");
  add_search(*command, *options);
  command->add_option(
      "--report", options->report,
      "folder for report.html, report.md, its pictures and diagnosis.json, made if need be; or "
      "a file that ends in .html for the page alone");
  command->add_option(
      "--model", options->model,
      "folder for rovers/*.json and soils/*.json of the corrected model, where one is offered: put into a "
      "data folder they are planned with");
  command->footer(
      "Example: what do these drives show that the simulator lacks?\n"
      "  slipway diagnose data/gap-practice/p05 --report p05\n"
      "Example: what has changed since these drives were made?\n"
      "  slipway diagnose sols-20-30 --reference sols-1-19\n"
      "Exit status: 0 a diagnosis, whatever its verdict, 1 none, 2 input that can't be read, with every "
      "fault.");
  command->callback([options, &run] { run = [options] { return diagnose(*options); }; });
}

void add_watch_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<WatchCommand>();
  CLI::App* command = app.add_subcommand(
      "watch",
      "whether drives, in their order, still are what healthy ones were: since when, and what changed");
  command
      ->add_option(
          "campaign", options->campaign,
          "folder of a drive campaign, its drives in their order; or a table of measured steps (*.csv)")
      ->required();
  command->add_option("--rover", options->rover, "rover that made the steps of a table")
      ->capture_default_str();
  add_data_option(*command, options->data, "rovers and soils");
  CLI::Option* const reference = command->add_option(
      "--reference", options->reference, "folder of drives of the same rover that are taken as healthy");
  command
      ->add_option("--learn", options->learn,
                   "without a reference: so many of the campaign's first drives are taken as healthy")
      ->capture_default_str()
      ->check(CLI::Range(gap::kFewestLearnt, gap::kMostLearnt))
      ->excludes(reference);
  command
      ->add_option("--alpha", options->alpha,
                   "chance of an alarm while nothing changes, however long one watches")
      ->capture_default_str()
      ->check(CLI::Range(1e-9, 0.5));
  command->add_option("--without", options->without, "an effect that is not looked for, see slipway effects");
  command->add_flag("!--no-diagnosis", options->diagnose, "after an alarm, do not diagnose what has changed");
  add_search(*command, *options);
  command->add_option("--report", options->report,
                      "folder for report.html, report.md, its pictures and watch.json, made if need be; or a "
                      "file that ends in .html for the page alone");
  command->footer(
      "Example: is the rover still what it was in its first twelve drives?\n"
      "  slipway watch data/gap-practice/p01 --report p01.html\n"
      "Exit status: 0 nothing has changed, 6 something has, 1 no answer, 2 input that can't be read.");
  command->callback([options, &run] { run = [options] { return watch(*options); }; });
}

}  // namespace slipway::server
