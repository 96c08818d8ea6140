#include "server/cli/campaign_command.h"

#include <fmt/format.h>

#include <iostream>
#include <vector>

#include "api/files/drive_table/campaign_documents.h"
#include "api/files/drive_table/campaign_folder.h"
#include "api/files/drive_table/campaign_source.h"
#include "campaign/run_campaign.h"
#include "core/angle.h"
#include "server/cli/command_parts.h"
#include "server/cli/inquiry/data_folder.h"
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

}  // namespace slipway::server
