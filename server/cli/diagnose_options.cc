#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>

#include "server/cli/data_option.h"
#include "server/cli/diagnose_command.h"
#include "server/cli/largest_exact_whole.h"

namespace slipway::server {

void add_diagnose_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<DiagnoseCommand>();
  CLI::App* command = app.add_subcommand(
      "diagnose",
      "where prediction and recorded drives part, which effect is missing, how far the gap closes");
  command->add_option("campaign", options->campaign, "folder of a drive campaign")->required();
  add_data_option(*command, options->data, "rovers and soils");
  command->add_option("--without", options->without, "an effect that is not looked for, see slipway effects");
  command->add_option("--seed", options->seed, "the same seed gives the same answer")
      ->capture_default_str()
      ->check(CLI::Range(std::uint64_t{0}, kMaxExactWhole));
  command->add_option("--threads", options->threads, "at once; 0: as many as the machine has")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  command->add_flag("--json", options->json, "print the document, for machines");
  command->add_option("--report", options->report,
                      "folder for report.md, its pictures and diagnosis.json; made if need be");
  command->add_option(
      "--model", options->model,
      "folder for rovers/*.json and soils/*.json of the corrected model, where one is offered: put into a "
      "data folder they are planned with");
  command->footer(
      "Example: what do these drives show that the simulator lacks?\n"
      "  slipway diagnose data/gap-practice/p05 --report p05\n"
      "Exit status: 0 a diagnosis, whatever its verdict, 1 none, 2 input that can't be read, with every "
      "fault.");
  command->callback([options, &run] { run = [options] { return diagnose(*options); }; });
}

}  // namespace slipway::server
