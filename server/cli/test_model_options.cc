#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>

#include "core/largest_exact_whole.h"
#include "server/cli/data_option.h"
#include "server/cli/test_model_command.h"

namespace slipway::server {

void add_test_model_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<TestModelCommand>();
  CLI::App* command = app.add_subcommand(
      "test-model", "how well a corrected model predicts the drives of a campaign that it was not made of");
  command->add_option("campaign", options->campaign, "folder of a drive campaign")->required();
  command
      ->add_option("--model", options->model,
                   "folder of a corrected model, as slipway diagnose --model writes it")
      ->required();
  command->add_option(
      "--ground", options->ground,
      "a soil of this campaign that is the model's, where the other campaign called it otherwise");
  add_data_option(*command, options->data, "rovers and soils");
  command->add_option("--seed", options->seed, "of the resampling of drives")
      ->capture_default_str()
      ->check(CLI::Range(std::uint64_t{0}, kMaxExactWhole));
  command->add_option("--threads", options->threads, "at once; 0: as many as the machine has")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  command->add_flag("--json", options->json, "print the document, for machines");
  command->footer(
      "Example: does what the drives of one year showed hold in the next?\n"
      "  slipway diagnose year_1 --model corrected\n"
      "  slipway test-model year_2 --model corrected\n"
      "Exit status: 0 whatever the figures, 1 none, 2 input that can't be read, with every fault.");
  command->callback([options, &run] { run = [options] { return test_model(*options); }; });
}

}  // namespace slipway::server
