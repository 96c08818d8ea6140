#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>

#include "core/largest_exact_whole.h"
#include "server/cli/data_option.h"
#include "server/cli/gap_benchmark_command.h"

namespace slipway::server {

void add_gap_benchmark_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<GapBenchmarkCommand>();
  CLI::App* command = app.add_subcommand(
      "gap-benchmark",
      "diagnose a folder of campaigns (made first, if asked for), then score the diagnoses against its "
      "answers.json");
  command->add_option("folder", options->folder, "folder of drive campaigns, with answers.json")->required();
  command->add_option(
      "--make", options->make,
      "first make campaigns in that folder, by drives in motion: smoke (2), each, each_heavy_wheels (23)");
  add_data_option(*command, options->data, "rovers and soils");
  command->add_option("--only", options->only, "names of campaigns; all without it")->delimiter(',');
  command->add_option("--seed", options->seed, "the same seed gives the same campaigns and diagnoses")
      ->capture_default_str()
      ->check(CLI::Range(std::uint64_t{0}, kMaxExactWhole));
  command->add_option("--threads", options->threads, "at once; 0: as many as the machine has")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  command->add_option("--keep", options->keep, "folder for each campaign's diagnosis, NAME.json");
  command->add_option("--csv", options->csv, "file for the scores, one line a campaign");
  command->add_option("--marginals-csv", options->marginals_csv,
                      "file for the marginal probabilities, one line a campaign and effect");
  CLI::Option* const variant =
      command
          ->add_option("--variant", options->variant,
                       "of the diagnosis, to compare with: as-is, no-retuning, no-closures, no-unknown, "
                       "no-wrench, old-naming, no-wrench-old-naming, "
                       "nearest-signature, evidence-without-retuning, sample-level-folds, sparse-regression, "
                       "gaussian-process")
          ->capture_default_str();
  CLI::Option* const without_each =
      command->add_flag("--without-each", options->without_each,
                        "diagnose again with each hidden effect taken out of the library");
  command->add_option("--withheld-csv", options->withheld_csv,
                      "file for the scores with effects taken out, one line an effect");
  CLI::Option* const oracle = command->add_flag(
      "--oracle", options->oracle,
      "diagnose again with the hidden effects given: how much of the gap could have been closed?");
  command->add_flag("--references", options->references,
                    "with the drives in the folder's references/NAME taken as healthy, where there are some: "
                    "what has changed since?");
  CLI::Option* const needed =
      command->add_flag("--drives-needed", options->drives_needed,
                        "instead: how many drives a right answer takes where next drives are those that "
                        "diagnoses propose, and where they are random");
  for (CLI::Option* const other : {variant, without_each, oracle}) needed->excludes(other);
  command
      ->add_option("--random-repeats", options->random_repeats,
                   "with --drives-needed: runs of each campaign with random drives")
      ->capture_default_str()
      ->check(CLI::Range(1, 100));
  command->add_flag("--json", options->json, "print the document, for machines");
  command->footer(
      "Example: how often is the diagnosis right on campaigns that it has not seen?\n"
      "  sealed_campaigns blind-1 --seed 1 --set blind && slipway gap-benchmark blind-1 --keep "
      "blind-1-found\n"
      "Example: with campaigns of the program's own making?\n"
      "  slipway gap-benchmark made-1 --make each --seed 1\n"
      "Example: are the drives that it proposes worth following?\n"
      "  slipway gap-benchmark blind-1 --drives-needed\n"
      "Interrupted (Ctrl-C) while it makes, the same command goes on; later, it scores what is done. Exit "
      "status: 0 every campaign is scored, 1 interrupted, or a campaign or file is missing from the answer, "
      "2 "
      "something can't be read.");
  command->callback([options, &run] { run = [options] { return gap_benchmark(*options); }; });
}

}  // namespace slipway::server
