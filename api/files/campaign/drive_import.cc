#include "api/files/campaign/drive_import.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <system_error>

#include "api/files/campaign/import_attitude.h"
#include "api/files/campaign/import_clock.h"
#include "api/files/campaign/recorded_table.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/writer.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;
using json::JsonValue;

constexpr std::uintmax_t kMaxFileBytes = 512U << 20U;
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

std::optional<std::string> bytes_of(const fs::path& path) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error || size > kMaxFileBytes) return std::nullopt;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(stream), {}};
}

// A full turn in the unit that a column was recorded in; 0 of what is no angle.
double turn_of(const ImportedColumn& column) {
  constexpr double kTurn_deg = 360.0;
  return column.to.ends_with("_deg") ? kTurn_deg / std::abs(column.factor) : 0.0;
}

class Importer {
 public:
  Importer(ImportMapping mapping, fs::path folder)
      : mapping_(std::move(mapping)), folder_(std::move(folder)) {}

  ImportedCampaign run() {
    made_.name = mapping_.name;
    made_.mapping_file = mapping_.file;
    made_.known_file = mapping_.known;
    made_.from_ned = mapping_.axes == ImportAxes::kNed;
    made_.wheels = mapping_.wheels;
    made_.clock_unit = mapping_.clock.unit;
    faults_ = mapping_.faults;
    ask_for_columns();
    // Where the separator is unknown, what a log holds is as well.
    if (!mapping_.separator_at_fault)
      for (const ImportDrive& drive : mapping_.drives) read_drive(drive);
    if (!mapping_.known.empty())
      if (const auto known = read_known())
        made_.files.insert(made_.files.begin(), {"campaign.json", campaign_document(*known)});
    made_.passed_over.assign(passed_over_.begin(), passed_over_.end());
    made_.faults = std::move(faults_);
    return std::move(made_);
  }

 private:
  void ask_for_columns() {
    const auto add = [&](const ImportColumn& column) {
      made_.columns.push_back({column.key, column.to, column.from, column.unit, column.sign * column.factor,
                               column.offset, column.delay_s, std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity(), 0, 0, column.turned,
                               column.by_rate});
    };
    question_.separator = mapping_.separator;
    for (const ImportColumn& column : mapping_.columns) {
      if (!column.from.empty()) question_.asked.insert(column.from);
      if (!column.at_fault) add(column);
    }
    if (!mapping_.clock.column.empty()) question_.texts.insert(mapping_.clock.column);
    if (!mapping_.clock.plus_column.empty()) question_.texts.insert(mapping_.clock.plus_column);
    if (!mapping_.attitude || mapping_.attitude->at_fault) return;
    const auto& parts = mapping_.attitude->from;
    question_.asked.insert(parts.begin(), parts.end());
    for (const std::string_view angle : kAttitudeColumns)
      add({.key = std::string(kAttitudeKey),
           .to = std::string(angle),
           .from = fmt::format("{}", fmt::join(parts, " ")),
           .unit = "quaternion",
           .delay_s = mapping_.attitude->delay_s});
  }

  // Nothing where it can't be read, or is no document.
  std::optional<JsonValue> read_known() {
    const auto bytes = bytes_of(folder_ / mapping_.known);
    if (!bytes) {
      faults_.push_back({mapping_.file + "#/known",
                         fmt::format("{} can't be read beside the mapping", in_quotes(mapping_.known))});
      return std::nullopt;
    }
    made_.known_document = *bytes;
    auto known = json::parse(*bytes);
    if (!known) {
      for (Fault& fault : moved_under(mapping_.known + "#", known.error().faults))
        faults_.push_back(std::move(fault));
      if (known.error().faults.empty())
        faults_.push_back({mapping_.known + "#", mapping_.known + ": " + known.error().detail});
      return std::nullopt;
    }
    // Where there are none, the campaign's own reader says so.
    const JsonValue* const terrains = known->find("terrains");
    if (terrains != nullptr && terrains->is(JsonValue::Kind::kObject))
      for (const JsonValue& terrain : terrains->elements) copy_rasters(terrain);
    return std::move(*known);
  }

  // What is no file beside the mapping is none in the campaign, whose own reader then says so.
  void copy_rasters(const JsonValue& terrain) {
    const auto copy = [&](const JsonValue* name) {
      std::error_code error;
      if (name != nullptr && name->is(JsonValue::Kind::kString) &&
          fs::is_regular_file(folder_ / name->text, error))
        made_.copied.push_back(name->text);
    };
    copy(terrain.find("dem"));
    if (const JsonValue* const soil = terrain.find("soil")) copy(soil->find("raster"));
  }

  void read_drive(const ImportDrive& drive) {
    if (drive.file.empty()) return;  // which is a fault of the mapping
    const auto bytes = bytes_of(folder_ / drive.file);
    if (!bytes) {
      faults_.push_back(
          {drive.file + "#", fmt::format("{} can't be read beside the mapping, or has more than {} MB",
                                         in_quotes(drive.file), kMaxFileBytes >> 20U)});
      return;
    }
    const std::size_t before = faults_.size();
    const RecordedTable table = read_recorded_table(*bytes, drive.file, question_, faults_);
    if (faults_.size() > before) return;
    for (const std::string& note : table.notes) add_once(made_.notes, note);
    for (const std::string& name : table.names)
      if (!question_.asked.contains(name) && !question_.texts.contains(name)) passed_over_.insert(name);
    for (const auto& names : {question_.texts, question_.asked})
      for (const std::string& name : names)
        if (!table.place_of(name))
          faults_.push_back({drive.file + "#/1",
                             fmt::format("{}: {}", drive.file, unknown_name("column", name, table.names))});
    if (faults_.size() > before || mapping_.clock.column.empty() || mapping_.clock.at_fault) return;
    if (!told_of_parts_)
      if (const auto warning = quaternion_as_angles(mapping_, table)) {
        made_.warnings.push_back(*warning);
        told_of_parts_ = true;
      }
    if (const auto warning = ticks_as_decimals(mapping_.clock, table)) add_once(made_.warnings, *warning);
    convert(drive, table);
  }

  // Notes name no file: what is so of one log is mostly so of all.
  static void add_once(std::vector<std::string>& notes, const std::string& note) {
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
  }

  // By made_.columns, in the units of the log.
  std::vector<std::vector<double>> recorded_of(const ImportDrive& drive, const RecordedTable& table) {
    std::vector<std::vector<double>> recorded;
    for (const ImportedColumn& column : made_.columns) {
      if (column.key == kAttitudeKey) break;  // its columns are the last
      const std::size_t place = *table.place_of(column.from);
      std::vector<double>& values = recorded.emplace_back();
      for (const std::vector<double>& row : table.rows) values.push_back(row[place]);
    }
    if (recorded.size() < made_.columns.size())
      for (std::vector<double>& angles :
           angles_of_quaternions(*mapping_.attitude, drive.file, table, faults_))
        recorded.push_back(std::move(angles));
    return recorded;
  }

  void convert(const ImportDrive& drive, const RecordedTable& table) {
    const std::size_t before = faults_.size();
    bool as_text = false;
    const auto times = read_times(mapping_.clock, drive.file, table, made_.notes, as_text, faults_);
    if (as_text) made_.clock_unit.clear();
    const std::vector<std::vector<double>> recorded = recorded_of(drive, table);
    if (!times || faults_.size() > before || drive.at_fault) return;
    const std::vector<double>& time_s = *times;
    ImportedDrive made;
    made.index = drive.index;
    made.id = drive.id;
    made.file = drive.id + ".csv";
    made.log = drive.file;
    made.values.resize(made_.columns.size());
    for (std::size_t i = 0; i < time_s.size(); ++i) {
      if ((drive.from_s && time_s[i] < *drive.from_s) || (drive.to_s && time_s[i] > *drive.to_s)) continue;
      made.time_s.push_back(time_s[i]);
      made.lines.push_back(table.lines[i]);
      for (std::size_t c = 0; c < recorded.size(); ++c) {
        const ImportedColumn& column = made_.columns[c];
        made.values[c].push_back(
            column.factor * delayed(time_s, recorded[c], i, column.delay_s, turn_of(column)) + column.offset);
      }
    }
    blank_ends_of_delays(made_.columns, time_s, made);
    if (made.time_s.size() < 2) {
      faults_.push_back(
          {drive.file + "#", fmt::format("{}: drive {} has {} rows from from_s to to_s, must have 2",
                                         drive.file, drive.id, made.time_s.size())});
      return;
    }
    if (lasts_too_long(made)) return;
    if (mapping_.clock.from_first_row) {
      const double first_s = made.time_s.front();
      for (double& t : made.time_s) t -= first_s;
    }
    take_out_signs_of_rates(made);
    into_map_frame(made);
    describe(drive, made);
    made_.files.emplace_back(made.file, drive_text(made));
    made_.drives.push_back(std::move(made));
  }

  // Months of driving are microseconds that were taken for seconds: which is told once.
  bool lasts_too_long(const ImportedDrive& made) {
    constexpr double kLongest_s = 1e7;  // of a campaign's drives
    const double lasts_s = made.time_s.back() - made.time_s.front();
    if (lasts_s <= kLongest_s) return false;
    if (!told_of_months_)
      faults_.push_back(
          {mapping_.file + "#/clock/unit",
           fmt::format("drive {} lasts {:.3g} s by its clock {}, must be {:.0e} s at most: change the "
                       "key clock.unit (it is {}) to that of the recorded times",
                       made.id, lasts_s, in_quotes(mapping_.clock.column), kLongest_s,
                       in_quotes(mapping_.clock.unit))});
    told_of_months_ = true;
    return true;
  }

  std::vector<double>* values_of(ImportedDrive& drive, std::string_view column) const {
    for (std::size_t c = 0; c < made_.columns.size(); ++c)
      if (made_.columns[c].to == column) return &drive.values[c];
    return nullptr;
  }

  // Currents that are negative where their wheel turns backwards become positive where the motor drives.
  void take_out_signs_of_rates(ImportedDrive& made) {
    constexpr std::string_view kCurrent = "_current_a";
    for (std::size_t c = 0; c < made_.columns.size(); ++c) {
      const ImportedColumn& column = made_.columns[c];
      if (!column.by_rate) continue;
      const std::string rate = column.to.substr(0, column.to.size() - kCurrent.size()) + "_rate_deg_s";
      const std::vector<double>* const rates = values_of(made, rate);
      if (rates == nullptr) {
        add_fault_once({fmt::format("{}#/columns/{}/signed_by", mapping_.file, column.key),
                        fmt::format("there is no {} whose sign it could be: map it too", rate)});
        continue;
      }
      for (std::size_t i = 0; i < rates->size(); ++i)
        if ((*rates)[i] < 0.0) made.values[c][i] = -made.values[c][i];
    }
  }

  void add_fault_once(Fault fault) {
    if (std::find(faults_.begin(), faults_.end(), fault) == faults_.end())
      faults_.push_back(std::move(fault));
  }

  // To the campaign's map: x east, y north, z up; yaw from east to north, positive pitch nose down.
  void into_map_frame(ImportedDrive& drive) const {
    std::vector<double>* const x = values_of(drive, "x_m");
    std::vector<double>* const y = values_of(drive, "y_m");
    std::vector<double>* const z = values_of(drive, "z_m");
    const auto shift = [](std::vector<double>* values, double by) {
      if (values != nullptr)
        for (double& v : *values) v -= by;
    };
    shift(x, mapping_.origin_m[0]);
    shift(y, mapping_.origin_m[1]);
    shift(z, mapping_.origin_m[2]);
    if (mapping_.axes != ImportAxes::kNed) return;
    if (x != nullptr && y != nullptr) std::swap(*x, *y);
    const auto turned = [&](std::string_view column, double from) {
      if (std::vector<double>* const values = values_of(drive, column))
        for (double& v : *values) v = from - v;
    };
    turned("z_m", 0.0);
    turned("yaw_deg", 90.0);
    turned("pitch_deg", 0.0);
  }

  void describe(const ImportDrive& drive, ImportedDrive& made) {
    made.rows = made.time_s.size();
    made.duration_s = made.time_s.back() - made.time_s.front();
    std::vector<double> intervals;
    for (std::size_t i = 1; i < made.rows; ++i) intervals.push_back(made.time_s[i] - made.time_s[i - 1]);
    std::nth_element(intervals.begin(), intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2),
                     intervals.end());
    made.interval_s = intervals[intervals.size() / 2];
    made.commanded_m = drive.turn_in_place ? 0.0 : std::abs(drive.speed_m_s) * made.duration_s;
    const std::vector<double>* const x = values_of(made, "x_m");
    const std::vector<double>* const y = values_of(made, "y_m");
    if (x != nullptr && y != nullptr)
      made.travelled_m = std::hypot(x->back() - x->front(), y->back() - y->front());
    for (std::size_t c = 0; c < made.values.size(); ++c)
      for (const double value : made.values[c]) {
        ImportedColumn& column = made_.columns[c];
        ++(std::isfinite(value) ? column.values : column.missing);
        if (!std::isfinite(value)) continue;
        column.lowest = std::min(column.lowest, value);
        column.highest = std::max(column.highest, value);
      }
  }

  std::string drive_text(const ImportedDrive& drive) const {
    std::string text = "t_s";
    for (const ImportedColumn& column : made_.columns) text += "," + column.to;
    text += '\n';
    for (std::size_t i = 0; i < drive.rows; ++i) {
      text += fmt::format("{:.15g}", drive.time_s[i]);  // seconds since 1970 to the microsecond
      for (const std::vector<double>& values : drive.values)
        text += std::isfinite(values[i]) ? fmt::format(",{:.9g}", values[i]) : ",";
      text += '\n';
    }
    return text;
  }

  const ImportDrive& drive_of(const ImportedDrive& made) const {
    return *std::find_if(mapping_.drives.begin(), mapping_.drives.end(),
                         [&](const ImportDrive& drive) { return drive.index == made.index; });
  }

  // What was known, with name and drives of the mapping.
  std::string campaign_document(const JsonValue& known) const {
    json::Writer w;
    w.begin_object().text("format", "drive-campaign/1").text("name", mapping_.name);
    for (std::size_t k = 0; k < known.keys.size(); ++k) {
      const std::string& key = known.keys[k];
      if (key == "format" || key == "name" || key == "drives") continue;
      w.key(key);
      json::write_value(w, known.elements[k]);
    }
    w.key("drives").begin_array();
    for (const ImportedDrive& made : made_.drives) {
      const ImportDrive& drive = drive_of(made);
      w.begin_object().text("id", drive.id).text("file", made.file).text("terrain", drive.terrain);
      if (!drive.repeat_of.empty()) w.text("repeat_of", drive.repeat_of);
      w.key("commanded").begin_object();
      w.exact("speed_m_s", drive.speed_m_s).exact("curvature_1_m", drive.curvature_1_m);
      if (drive.turn_in_place) w.exact("turn_rate_deg_s", drive.turn_rate_deg_s);
      w.boolean("turn_in_place", drive.turn_in_place).exact("duration_s", made.duration_s);
      w.end_object().end_object();
    }
    w.end_array().end_object();
    return w.take();
  }

  ImportMapping mapping_;
  fs::path folder_;
  ImportedCampaign made_;
  TableQuestion question_;
  std::set<std::string> passed_over_;
  bool told_of_parts_ = false;   // of a quaternion
  bool told_of_months_ = false;  // that a drive seems to last
  std::vector<Fault> faults_;
};

}  // namespace

const ImportedColumn* column_with(const ImportedCampaign& campaign, std::string ImportedColumn::*part,
                                  std::string_view value) {
  const auto at = std::find_if(campaign.columns.begin(), campaign.columns.end(),
                               [&](const ImportedColumn& column) { return column.*part == value; });
  return at == campaign.columns.end() ? nullptr : &*at;
}

Result<ImportedCampaign> import_drives(const fs::path& mapping) {
  const auto bytes = bytes_of(mapping);
  if (!bytes)
    return fail(ErrorCode::kUnreadableData, in_quotes(mapping.string()) + " can't be read",
                {{"", in_quotes(mapping.string()) + " can't be read"}});
  auto read = read_import_mapping(*bytes, mapping.filename().string());
  if (!read) return fail(read.error());
  return Importer(std::move(*read), mapping.parent_path().empty() ? fs::path(".") : mapping.parent_path())
      .run();
}

}  // namespace slipway::api
