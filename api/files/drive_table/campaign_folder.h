#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "api/files/file_lock.h"
#include "campaign/campaign_summary.h"
#include "campaign/drive_record.h"
#include "campaign/drive_table.h"
#include "core/result.h"

namespace slipway::api {

// A campaign on disk: campaign.json, a CSV for each drive, the terrains, summary.json, plots, and a record of
// each drive that is done, drives/ID.json. Every file appears under its name only when it is whole, and a
// drive's record after its other files: a process that is killed leaves drives that are done and drives that
// are not, never half of one.
class CampaignFolder {
 public:
  // Makes the folder, or finds what an earlier run of the same table has done in it. Errors: conflict where
  // it holds a campaign of something else (with `start_over` its drives are deleted first) or where another
  // process makes one in it; unwritable_file.
  static Result<CampaignFolder> open(std::filesystem::path folder, std::string digest, bool start_over);

  // The drives that are done, by id.
  const std::map<std::string, campaign::DriveRecord>& done() const { return done_; }

  // Records that can't be read: their drives are not done. A sentence each.
  const std::vector<std::string>& notes() const { return notes_; }

  // Writes a drive's files. For several threads at once; does not change done().
  Result<void> write_drive(const campaign::DriveTable& table, const campaign::TableDrive& drive,
                           const campaign::MadeDrive& made) const;

  // Reads what is done and writes what is of the whole campaign: campaign.json, terrains, summary and plots.
  Result<std::vector<campaign::TerrainSummary>> conclude(const campaign::DriveTable& table,
                                                         std::span<const campaign::TableDrive> drives);

 private:
  CampaignFolder(std::filesystem::path folder, std::string digest)
      : folder_(std::move(folder)), digest_(std::move(digest)) {}
  Result<void> read_records();
  void delete_drives();
  Result<void> write(const std::string& file, const std::string& bytes) const;
  Result<std::vector<std::string>> write_measurements(const campaign::DriveTable& table,
                                                      const campaign::TableDrive& drive,
                                                      const campaign::MadeDrive& made) const;
  Result<void> write_terrains(const campaign::DriveTable& table,
                              std::span<const campaign::TableDrive> drives) const;

  std::filesystem::path folder_;
  std::string digest_;
  std::optional<FileLock> lock_;  // of the folder, while this lives
  std::map<std::string, campaign::DriveRecord> done_;
  std::vector<std::string> notes_;
};

}  // namespace slipway::api
