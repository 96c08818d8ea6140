#include "api/files/campaign/import_faults.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <set>
#include <system_error>

#include "api/files/campaign/recorded_table.h"
#include "api/json/text_place.h"

namespace slipway::api {
namespace {

constexpr std::string_view kDocument = "campaign.json#";
constexpr std::string_view kDrives = "/drives";
constexpr std::string_view kBeyondRange = ", must be in [";
constexpr std::size_t kHeaderLines = 1;

// A number at the beginning of a text, and what stands behind it.
std::optional<std::size_t> leading_number(std::string_view& text) {
  std::size_t number = 0;
  const auto [rest, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failed != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(rest - text.data()));
  return number;
}

// The message without the place in the campaign that was made, which nobody has: "..., column 3 (/rover): ".
std::string_view without_place(std::string_view message) {
  constexpr std::string_view kBehindPlace = "): ";
  const std::size_t at = message.find(kBehindPlace);
  return at == std::string_view::npos ? message : message.substr(at + kBehindPlace.size());
}

class Placing {
 public:
  explicit Placing(const ImportedCampaign& campaign) : campaign_(campaign), all_(campaign.faults) {}

  void add(const Fault& fault) {
    const std::string_view pointer = fault.pointer;
    if (pointer.starts_with(kDocument))
      add_of_document(pointer.substr(kDocument.size()), fault);
    else
      add_of_drive(fault);
  }
  std::vector<Fault> take() {
    for (const auto& [place, beyond] : beyond_)
      all_[beyond.fault].message += fmt::format(
          "{}. If it was recorded in another unit, change the key unit of "
          "columns.\"{}\" of {} (it is {}); else leave wrong cells empty",
          other_lines(beyond.lines), beyond.column->key, campaign_.mapping_file, beyond.column->unit);
    return std::move(all_);
  }

 private:
  bool has_own() const { return !campaign_.faults.empty(); }

  void add_of_document(std::string_view pointer, const Fault& fault) {
    if (!pointer.starts_with(kDrives)) {
      all_.push_back({fmt::format("{}#{}", campaign_.known_file, pointer),
                      json::with_place(campaign_.known_file, campaign_.known_document, pointer,
                                       without_place(fault.message))});
      return;
    }
    // Drives that could not be made are missing in the list, and to those that repeat them.
    if (has_own() && (pointer == kDrives || pointer.ends_with("/repeat_of"))) return;
    std::string of_mapping(pointer);
    if (std::string_view rest = pointer.substr(std::min(pointer.size(), kDrives.size() + 1)); !rest.empty())
      if (const auto made = leading_number(rest); made && *made < campaign_.drives.size())
        of_mapping = fmt::format("{}/{}{}", kDrives, campaign_.drives[*made].index, rest);
    all_.push_back({fmt::format("{}#{}", campaign_.mapping_file, of_mapping),
                    std::string(without_place(fault.message))});
  }

  void add_of_drive(const Fault& fault) {
    const auto drive = std::find_if(campaign_.drives.begin(), campaign_.drives.end(),
                                    [&](const auto& d) { return fault.pointer.starts_with(d.file + "#/"); });
    if (drive == campaign_.drives.end()) return add_of_file(fault);
    std::string_view rest = std::string_view(fault.pointer).substr(drive->file.size() + 2);
    const auto line = leading_number(rest);
    if (!line || *line > drive->lines.size() + kHeaderLines) return all_.push_back(fault);
    if (*line <= kHeaderLines) return add_of_columns(fault);
    const std::string_view name = rest.empty() ? rest : rest.substr(1);
    std::string_view from = name;
    const ImportedColumn* of = nullptr;
    for (const ImportedColumn& column : campaign_.columns)
      if (column.to == name) of = &column;
    if (of != nullptr) from = of->from;
    const std::size_t row = *line - kHeaderLines - 1;
    if (of != nullptr && fault.message.find(kBeyondRange) != std::string::npos) {
      Beyond& beyond = beyond_[{drive->log, of->to}];
      beyond.lines.push_back(drive->lines[row]);
      if (beyond.lines.size() > 1) return;
      beyond.fault = all_.size();
      beyond.column = of;
      beyond.file = drive->file;
    }
    all_.push_back({fmt::format("{}#/{}/{}", drive->log, drive->lines[row], from),
                    fmt::format("{}: {}", place_in_log(*drive, row, from), without_place(fault.message))});
  }

  // How many faults more there are in a file says nothing where one stands for all of its column.
  void add_of_file(const Fault& fault) {
    const bool told = std::any_of(beyond_.begin(), beyond_.end(), [&](const auto& beyond) {
      return fault.pointer == beyond.second.file + "#";
    });
    if (!told) all_.push_back(fault);
  }

  // The header of every drive is made of the mapping's columns: what it lacks is told once, and not where a
  // column was at fault itself.
  void add_of_columns(const Fault& fault) {
    const std::string words(without_place(fault.message));
    if (has_own() || !told_of_columns_.insert(words).second) return;
    all_.push_back({fmt::format("{}#/columns", campaign_.mapping_file), words});
  }

  // Values of a column of a log that the format has no room for: one fault, and where the others are.
  struct Beyond {
    std::size_t fault = 0;  // in all_
    const ImportedColumn* column = nullptr;
    std::string file;  // in the campaign that was made
    std::vector<std::size_t> lines;
  };

  const ImportedCampaign& campaign_;
  std::vector<Fault> all_;
  std::map<std::pair<std::string, std::string>, Beyond> beyond_;  // by log and column
  std::set<std::string> told_of_columns_;
};

}  // namespace

std::vector<Fault> faults_of_import(const ImportedCampaign& campaign, std::span<const Fault> of_campaign) {
  Placing placing(campaign);
  for (const Fault& fault : of_campaign) placing.add(fault);
  return placing.take();
}

std::string place_in_log(const ImportedDrive& drive, std::size_t row, std::string_view column) {
  return fmt::format("{}, line {} ({})", drive.log, drive.lines[row], column);
}

}  // namespace slipway::api
