#include "server/cli/commands/import_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>
#include <vector>

#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/campaign/drive_import.h"
#include "api/files/campaign/import_faults.h"
#include "api/files/campaign/import_plausibility.h"
#include "api/files/whole_file.h"
#include "api/json/faults.h"
#include "api/report/import_chart.h"
#include "gap/diagnosis/model/reading_plausibility.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/exit_status.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {
namespace {

namespace fs = std::filesystem;

std::string columns_words(const api::ImportedCampaign& campaign) {
  TextTable table({"column", "from", "unit", "times", "plus", "delay, s", "lowest", "highest", "missing"});
  for (const api::ImportedColumn& c : campaign.columns)
    table.add({c.to, c.from, c.unit, fmt::format("{:.6g}", c.factor), fmt::format("{:.6g}", c.offset),
               fmt::format("{:.3g}", c.delay_s), c.values > 0 ? fmt::format("{:.5g}", c.lowest) : "",
               c.values > 0 ? fmt::format("{:.5g}", c.highest) : "",
               fmt::format("{} of {}", c.missing, c.missing + c.values)});
  return table.print();
}

std::string drives_words(const api::ImportedCampaign& campaign) {
  TextTable table({"drive", "rows", "lasts, s", "every, s", "commanded, m", "start to end, m"});
  for (const api::ImportedDrive& d : campaign.drives)
    table.add({d.id, fmt::format("{}", d.rows), fmt::format("{:.1f}", d.duration_s),
               fmt::format("{:.3g}", d.interval_s), fmt::format("{:.2f}", d.commanded_m),
               fmt::format("{:.2f}", d.travelled_m)});
  return table.print();
}

// Notes on readings that are hard to believe, which are told as warnings that name the mapping's keys.
void take_out_plausibility_notes(gap::DriveCampaign& read) {
  const std::vector<std::string> implausible = gap::notes_of_implausible_readings(read);
  std::erase_if(read.notes, [&](const std::string& note) {
    return std::find(implausible.begin(), implausible.end(), note) != implausible.end();
  });
}

std::string import_words(const api::ImportedCampaign& campaign, const gap::DriveCampaign& read) {
  std::string out =
      fmt::format("{}: {} drives; rover {}, soils ", campaign.name, campaign.drives.size(), read.rover->name);
  std::vector<std::string> soils;
  for (const gap::NominalSoil& soil : read.soils) soils.push_back(soil.name);
  out += fmt::format("{}, {} terrains, {} m/s2\n\n", fmt::join(soils, ", "), read.terrains.size(),
                     read.gravity_m_s2);
  out += columns_words(campaign);
  if (campaign.from_ned)
    out +=
        "the recorded axes are ned: in the campaign x_m is what y_m is read from and y_m what x_m is, z_m "
        "and pitch_deg have the other sign, and yaw_deg is 90 less it; the ranges above are the campaign's\n";
  out += "\n" + drives_words(campaign);
  if (!campaign.passed_over.empty())
    out += fmt::format("\nnot asked for: {}\n", fmt::join(campaign.passed_over, ", "));
  for (const std::string& note : campaign.notes) out += "note: " + note + "\n";
  for (const std::string& note : read.notes) out += "note: " + note + "\n";
  for (const std::string& warning : api::implausible_readings(campaign, read))
    out += "warning: " + warning + "\n";
  return out;
}

// A folder beside the one that is asked for, until it is known to be whole; taken away if it never is.
class Unfinished {
 public:
  explicit Unfinished(fs::path path) : path_(std::move(path)) {}
  ~Unfinished() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

Result<void> write_campaign(const api::ImportedCampaign& campaign, const fs::path& from,
                            const fs::path& folder) {
  if (auto made = api::make_folder(folder); !made) return made;
  for (const auto& [name, bytes] : campaign.files)
    if (auto written = api::write_whole_file(folder / name, bytes); !written) return written;
  for (const fs::path& raster : campaign.copied) {
    std::error_code error;
    fs::create_directories((folder / raster).parent_path(), error);
    fs::copy_file(from / raster, folder / raster, fs::copy_options::overwrite_existing, error);
    if (error)
      return fail(ErrorCode::kUnwritableFile,
                  fmt::format("{} can't be copied: {}", raster.string(), error.message()));
  }
  return {};
}

// The campaign that was made, as its own reader has it. Errors: unreadable_data with all faults of mapping,
// logs and campaign together.
Result<gap::DriveCampaign> read_made(const api::ImportedCampaign& campaign, const fs::path& folder,
                                     const api::Catalogue& catalogue) {
  const auto refused = [](std::vector<Fault> faults) {
    const std::string summary = api::summary_of(faults);
    return fail(ErrorCode::kUnreadableData, summary, std::move(faults));
  };
  std::error_code error;
  if (!fs::exists(folder / "campaign.json", error)) return refused(campaign.faults);
  auto read = api::load_drive_campaign(folder, catalogue);
  if (!read) return refused(api::faults_of_import(campaign, read.error().faults));
  std::vector<Fault> faults = campaign.faults;
  for (Fault& fault : api::impossible_values(campaign, *read)) faults.push_back(std::move(fault));
  if (!faults.empty()) return refused(std::move(faults));
  take_out_plausibility_notes(*read);
  return read;
}

}  // namespace

int import(const ImportCommand& options) {
  const auto catalogue = open_catalogue(options.data);
  if (!catalogue) return refuse_unreadable(catalogue.error());
  const auto campaign = api::import_drives(options.mapping);
  if (!campaign) return refuse_unreadable(campaign.error());
  std::error_code error;
  if (!options.out.empty() && fs::exists(options.out, error) && !fs::is_empty(options.out, error))
    return refuse({ErrorCode::kInvalidRequest,
                   options.out + " is not empty: nothing is written",
                   {{"/out", options.out + " is not empty"}}});
  const fs::path out =
      options.out.empty() ? fs::temp_directory_path() / "slipway-import" : fs::path(options.out);
  const Unfinished made(out.string() + fmt::format(".{}.part", getpid()));
  const fs::path beside = fs::path(options.mapping).parent_path();
  if (const auto written = write_campaign(*campaign, beside, made.path()); !written)
    return refuse(written.error());
  // The campaign's own reader has the last word. Its faults and those of the mapping and the logs are told
  // together.
  auto read = read_made(*campaign, made.path(), *catalogue);
  if (!read) return refuse_unreadable(read.error());
  if (!options.out.empty()) {
    fs::remove(options.out, error);
    fs::rename(made.path(), options.out, error);
    if (error)
      return refuse({ErrorCode::kUnwritableFile, fmt::format("{}: {}", options.out, error.message()), {}});
  }
  std::vector<OutputFile> files;
  if (!options.plot.empty()) files.push_back({options.plot, api::import_chart(*campaign)});
  return deliver(files, import_words(*campaign, *read));
}

}  // namespace slipway::server
