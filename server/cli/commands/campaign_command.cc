#include "server/cli/commands/campaign_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <vector>

#include "api/files/drive_table/campaign_documents.h"
#include "api/files/drive_table/campaign_folder.h"
#include "api/files/drive_table/campaign_source.h"
#include "campaign/run_campaign.h"
#include "core/angle.h"
#include "server/cli/commands/import_command.h"
#include "server/cli/commands/spice_import_command.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/inquiry/data_option.h"
#include "server/cli/inquiry/drive_choice.h"
#include "server/cli/terminal/terminal_progress.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {
namespace {

using slipway::campaign::Band;
using slipway::campaign::TableDrive;
using slipway::campaign::TerrainSummary;

int print_list(const std::string& data, const api::Catalogue& catalogue) {
  TextTable text({"campaign", "drives", "rover", "summary"});
  for (const std::string& name : api::campaign_names(data)) {
    const auto loaded = api::load_campaign_table(name, data, catalogue);
    if (!loaded) return refuse(loaded.error());
    text.add({name, fmt::format("{}", slipway::campaign::expand(loaded->table).size()),
              loaded->table.rover->name, loaded->table.summary});
  }
  return deliver({}, text.print());
}

int print_drives(const slipway::campaign::DriveTable& table, const std::vector<TableDrive>& drives) {
  TextTable text({"drive", "x", "y", "heading", "legs", "terrain"});
  for (const TableDrive& drive : drives)
    text.add({drive.id, fmt::format("{:g} m", drive.start.x_m), fmt::format("{:g} m", drive.start.y_m),
              fmt::format("{:g} deg", deg_from_rad(drive.start.yaw_rad)),
              fmt::format("{}", table.entries[drive.entry].legs.size()), table.terrains[drive.terrain].name});
  return deliver({}, text.print() + fmt::format("{} drives\n", drives.size()));
}

std::string range_of(const std::optional<Band>& band, double unit, int decimals) {
  if (!band) return "";
  return fmt::format("{:.{}f} ({:.{}f} to {:.{}f})", unit * band->p50, decimals, unit * band->p05, decimals,
                     unit * band->p95, decimals);
}

std::string summary_table(const std::vector<TerrainSummary>& summaries) {
  constexpr double kDegPerRad = deg_from_rad(1.0);
  TextTable text({"terrain", "drives", "slip", "least", "most", "heading error, deg", "turn error, deg",
                  "repeats apart, mm", "ends"});
  for (const TerrainSummary& s : summaries) {
    std::vector<std::string> ends;
    for (const auto& [end, count] : s.ends) ends.push_back(fmt::format("{} {}", count, end));
    text.add({s.terrain, fmt::format("{}", s.drives), range_of(s.slip_ratio, 1.0, 3),
              s.slip_ratio ? fmt::format("{:.3f}", s.slip_ratio->lowest) : "",
              s.slip_ratio ? fmt::format("{:.3f}", s.slip_ratio->highest) : "",
              range_of(s.heading_error_rad, kDegPerRad, 1), range_of(s.turn_error_rad, kDegPerRad, 1),
              s.repeat_spread_m ? fmt::format("{:.1f}", 1e3 * s.repeat_spread_m->p50) : "",
              fmt::format("{}", fmt::join(ends, ", "))});
  }
  return text.print() + "medians, with 5 and 95 % of drives in brackets\n";
}

// Makes what is not done yet.
Result<void> make(const CampaignCommand& options, const slipway::campaign::DriveTable& table,
                  const std::vector<TableDrive>& drives, const api::CampaignFolder& folder) {
  std::vector<TableDrive> missing;
  for (const TableDrive& drive : drives)
    if (!folder.done().contains(drive.id)) missing.push_back(drive);
  if (missing.size() < drives.size())
    std::cerr << fmt::format("{} of {} drives are done already\n", drives.size() - missing.size(),
                             drives.size());
  TerminalProgress progress;
  return slipway::campaign::run_campaign(
      table, missing, {.threads = static_cast<std::size_t>(options.threads)},
      [&](const TableDrive& drive, const slipway::campaign::MadeDrive& made) {
        return folder.write_drive(table, drive, made);
      },
      progress);
}

int conclude(const CampaignCommand& options, const slipway::campaign::DriveTable& table,
             const std::vector<TableDrive>& all, api::CampaignFolder& folder) {
  const auto summaries = folder.conclude(table, all);
  if (!summaries) return refuse(summaries.error());
  int status = deliver({}, options.json ? api::json::campaign_summary_document(table, all.size(), *summaries)
                                        : summary_table(*summaries));
  for (const TableDrive& drive : all) {
    const auto record = folder.done().find(drive.id);
    if (record == folder.done().end() || record->second.answered) continue;
    std::cerr << fmt::format("{} has no answer: {}: {}\n", drive.id, record->second.end,
                             record->second.reason);
    status = 1;
  }
  return status;
}

}  // namespace

int campaign(const CampaignCommand& options) {
  const auto data = data_folder(options.data);
  if (!data) return refuse(data.error());
  const auto catalogue = api::load_catalogue(*data);
  if (!catalogue) return refuse(catalogue.error());
  std::cerr << left_out_text(*catalogue);
  if (options.table == "list") return print_list(*data, *catalogue);
  const auto loaded = api::load_campaign_table(options.table, *data, *catalogue);
  if (!loaded) return refuse(loaded.error());
  const std::vector<TableDrive> all = slipway::campaign::expand(loaded->table);
  const auto drives = chosen_drives(all, options.only, "/only");
  if (!drives) return refuse(drives.error());
  if (options.dry_run) return print_drives(loaded->table, *drives);
  if (options.out.empty())
    return refuse({ErrorCode::kInvalidRequest, "a campaign needs a folder: --out FOLDER", {}});
  auto folder = api::CampaignFolder::open(options.out, loaded->digest, options.start_over);
  if (!folder) return refuse(folder.error());
  for (const std::string& note : folder->notes()) std::cerr << note << "\n";
  if (const auto made = make(options, loaded->table, *drives, *folder); !made) return refuse(made.error());
  return conclude(options, loaded->table, all, *folder);
}

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
