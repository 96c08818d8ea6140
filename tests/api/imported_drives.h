#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/campaign/drive_import.h"
#include "api/files/campaign/import_faults.h"
#include "api/files/campaign/import_plausibility.h"
#include "api/json/parse.h"
#include "api/json/writer.h"
#include "core/angle.h"
#include "core/csv_cells.h"
#include "small_world.h"

namespace slipway::api::testing {

namespace fs = std::filesystem;

// A row of a log by its columns.
using LogCells = std::map<std::string, std::string>;

struct LoggedDrive {
  std::string id, terrain;
  double speed_m_s, curvature_1_m;
};
// Straight, to the left, to the right, backwards on level ground; up a slope and down.
inline const std::vector<LoggedDrive> kLoggedDrives{
    {"D001", "tilt_00", 0.05, 0.0},  {"D006", "tilt_00", 0.04, 0.4},  {"D007", "tilt_00", 0.05, -0.4},
    {"D008", "tilt_00", -0.04, 0.0}, {"D024", "tilt_10", 0.025, 0.0}, {"D031", "tilt_15", 0.05, 0.0}};
inline const std::vector<std::string> kLoggedWheels{"lf", "lm", "lr", "rf", "rm", "rr"};

inline double cell_number(const std::string& text) {
  return std::stod(text);
}

inline std::string cell_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

// Drives of a practice campaign as a team would have logged and mapped them, for tests that change one thing.
class ImportedDrives : public ::testing::Test {
 protected:
  ImportedDrives() {
    const auto campaign = json::parse(file_bytes(practice() / "campaign.json"));
    json::Writer known;
    known.begin_object();
    for (std::size_t k = 0; k < campaign->keys.size(); ++k) {
      const std::string& key = campaign->keys[k];
      if (key == "format" || key == "name" || key == "drives") continue;
      known.key(key);
      json::write_value(known, campaign->elements[k]);
    }
    known.end_object();
    write_file(team() / "known.json", known.take());
    for (const auto& entry : fs::directory_iterator(practice()))
      if (entry.path().extension() == ".tif") fs::copy_file(entry.path(), team() / entry.path().filename());
    for (const std::string& wheel : kLoggedWheels) wheels_[wheel] = wheel;
    for (const char* column : {"x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg"})
      columns_[column] = from(column);
    for (const char* column :
         {"{w}_rate_deg_s", "{w}_steer_deg", "{w}_current_a", "{w}_motor_temp_c", "{w}_sinkage_m"})
      columns_[column] = from(column);
    log([](LogCells&) {});
  }

  static fs::path practice() { return fs::path(SLIPWAY_DATA_FOLDER) / "gap-practice/p01"; }
  fs::path team() const { return folder_.path(); }
  static std::string from(const std::string& column, const std::string& more = "") {
    return "from = \"" + column + "\"" + more;
  }

  // Writes the logs with every row changed so.
  void log(const std::function<void(LogCells&)>& change) const {
    for (const LoggedDrive& drive : kLoggedDrives) {
      const std::string bytes = file_bytes(practice() / (drive.id + ".csv"));
      const std::vector<CsvLine> lines = csv_lines(bytes);
      const auto names = csv_cells(lines[0].text);
      std::string header, rows;
      for (std::size_t i = 1; i < lines.size(); ++i) {
        const auto cells = csv_cells(lines[i].text);
        LogCells row;
        for (std::size_t c = 0; c < cells.size(); ++c) row[std::string(names[c])] = cells[c];
        change(row);
        header.clear();
        for (const auto& [name, cell] : row) {
          header += name + ",";
          rows += cell + ",";
        }
        header.back() = rows.back() = '\n';
      }
      write_file(team() / (drive.id + ".csv"), header + rows);
    }
  }

  // Multiplies what the rows have of columns that end so, of wheels that begin so.
  static void multiply(LogCells& row, const std::string& ending, double by,
                       const std::string& beginning = "") {
    for (auto& [name, cell] : row)
      if (name.ends_with(ending) && name.starts_with(beginning) && !cell.empty())
        cell = cell_text(by * cell_number(cell));
  }

  std::string mapping() const {
    std::ostringstream text;
    text << "format = \"drive-import/1\"\nname = \"yard\"\nknown = \"known.json\"\n"
         << top_ << "[clock]\n"
         << clock_ << "\n[wheels]\n";
    for (const auto& [own, theirs] : wheels_) text << own << " = \"" << theirs << "\"\n";
    text << "[columns]\n";
    for (const auto& [to, how] : columns_) text << '"' << to << "\" = {" << how << "}\n";
    for (const LoggedDrive& drive : kLoggedDrives)
      text << "[[drives]]\nid = \"" << drive.id << "\"\nfile = \"" << drive.id << ".csv\"\nterrain = \""
           << drive.terrain << "\"\nspeed_m_s = " << drive.speed_m_s
           << "\ncurvature_1_m = " << (turns_ * drive.curvature_1_m) << "\n";
    return text.str();
  }

  // Imports what there is. Warnings and faults are those that a person is told.
  void import() {
    write_file(team() / "yard.toml", mapping());
    const auto campaign = import_drives(team() / "yard.toml");
    ASSERT_TRUE(campaign) << campaign.error().detail;
    campaign_ = *campaign;
    warnings_.clear();
    faults_ = campaign_.faults;
    const fs::path made = team() / "made";
    fs::remove_all(made);
    fs::create_directory(made);
    for (const auto& [name, bytes] : campaign_.files) write_file(made / name, bytes);
    for (const fs::path& raster : campaign_.copied) fs::copy_file(team() / raster, made / raster);
    const auto read = load_drive_campaign(made, Catalogue{});
    if (!read) {
      faults_ = faults_of_import(campaign_, read.error().faults);
      return;
    }
    for (const Fault& fault : impossible_values(campaign_, *read)) faults_.push_back(fault);
    warnings_ = implausible_readings(campaign_, *read);
    first_yaw_deg_ = deg_from_rad(read->drives[0].samples[0].attitude.yaw_rad);
  }

  std::string told() const {
    std::string all;
    for (const Fault& fault : faults_) all += "\n  fault: " + fault.message;
    for (const std::string& warning : warnings_) all += "\n  warning: " + warning;
    return all;
  }
  void expect_none() {
    import();
    EXPECT_TRUE(warnings_.empty() && faults_.empty()) << told();
  }
  // One warning and no fault, with all these words in it.
  void expect_warning(const std::vector<std::string>& words) {
    import();
    EXPECT_TRUE(faults_.empty()) << told();
    ASSERT_EQ(warnings_.size(), 1U) << told();
    for (const std::string& word : words)
      EXPECT_NE(warnings_[0].find(word), std::string::npos) << word << " is not in" << told();
  }
  // One fault with all these words in it.
  void expect_fault(const std::vector<std::string>& words) {
    import();
    ASSERT_EQ(faults_.size(), 1U) << told();
    for (const std::string& word : words)
      EXPECT_NE(faults_[0].message.find(word), std::string::npos) << word << " is not in" << told();
  }

  ScratchFolder folder_;
  std::map<std::string, std::string> wheels_, columns_;
  std::string top_, clock_ = "from = \"t_s\"";
  double turns_ = 1.0;
  ImportedCampaign campaign_;
  std::vector<std::string> warnings_;
  std::vector<Fault> faults_;
  double first_yaw_deg_ = 0.0;
};

}  // namespace slipway::api::testing
