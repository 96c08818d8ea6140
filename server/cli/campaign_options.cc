#include <CLI/CLI.hpp>
#include <memory>

#include "server/cli/campaign_command.h"
#include "server/cli/data_option.h"
#include "server/cli/import_command.h"
#include "server/cli/spice_import_command.h"

namespace slipway::server {
namespace {

void add_spice(CLI::App& import, std::function<int()>& run) {
  const auto options = std::make_shared<SpiceImportCommand>();
  CLI::App* const command = import.add_subcommand(
      "spice", "make a table of steps with measured slip of a rover's SPICE kernels (Curiosity's)");
  command
      ->add_option(
          "kernels", options->kernels,
          "files in any order, told by their content: positions (SPK), attitudes (CK), clock (SCLK), "
          "leap seconds (LSK), landing site (SPK)")
      ->required();
  command->add_option("--out", options->out, "file of the steps (CSV, \"slip-steps/1\")")->required();
  command->footer(
      "Example:\n"
      "  slipway import spice rover.bsp rover.bc clock.tsc landing_site.bsp --out steps.csv\n"
      "Exit status: 0 written, 1 it could not be written, 2 a kernel can't be used or no step is in them.");
  command->callback([options, &run] { run = [options] { return import_spice(*options); }; });
}

// What is given to `import` itself would be ignored where its subcommand runs.
void refuse_beside_subcommand(const CLI::App& import) {
  for (const CLI::Option* const option : import.get_options())
    if (option->count() > 0)
      throw CLI::ValidationError(option->get_name(), "can't be given before the subcommand spice");
}

}  // namespace

void add_campaign_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<CampaignCommand>();
  CLI::App* command =
      app.add_subcommand("campaign", "make a table of drives and record them as a drive campaign");
  command->add_option("table", options->table, "file of a table, name of a shipped one, or list")->required();
  add_data_option(*command, options->data, "rovers, soils and campaigns");
  command->add_option("--out", options->out, "folder of the campaign; made where it is not there");
  command->add_option("--threads", options->threads, "at once; 0: as many as the machine has")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  command->add_option("--only", options->only,
                      "ids of drives, * and ? stand for anything; campaign.json then holds what is done");
  command->add_flag("--no-resume", options->start_over, "delete what an earlier run has done");
  command->add_flag("--dry-run", options->dry_run, "print which drives there are, make none");
  command->add_flag("--json", options->json, "print the summary as a document, for machines");
  command->footer(
      "Example: the tilt table of the ROAMS paper, given up and gone on with at will\n"
      "  slipway campaign fido_table_1 --out fido\n"
      "Exit status: 0 every drive has an answer (getting stuck is one), 1 one has none, 2 the table has "
      "faults.");
  command->callback([options, &run] { run = [options] { return campaign(*options); }; });
}

void add_import_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<ImportCommand>();
  CLI::App* command = app.add_subcommand(
      "import",
      "make a drive campaign of a team's own CSV files, by a mapping of names, units, axes and clocks");
  command->add_option("mapping", options->mapping, "file of a mapping (TOML, \"drive-import/1\")");
  add_data_option(*command, options->data, "rovers and soils");
  command->add_option("--out", options->out,
                      "folder of the campaign; without it only what was understood is said");
  command->add_option("--plot", options->plot, "file for a picture of what was read (SVG)");
  command->footer(
      "Example: what would be read of these files?\n"
      "  slipway import yard.toml --plot yard.svg\n"
      "Exit status: 0 a campaign, 1 it could not be written, 2 faults, all of them at once.");
  command->require_subcommand(0, 1);
  add_spice(*command, run);
  // The callbacks of a command run after those of its subcommands.
  command->callback([command, options, &run] {
    if (!command->get_subcommands().empty()) return refuse_beside_subcommand(*command);
    if (options->mapping.empty()) throw CLI::RequiredError("mapping");
    run = [options] { return import(*options); };
  });
}

}  // namespace slipway::server
