#include "api/files/drive_table/measured_finals.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include "api/files/drive_table/measured_campaign.h"
#include "api/files/terrain_site.h"
#include "core/angle.h"
#include "core/csv_cells.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 3> kPose{"x_m", "y_m", "yaw_deg"};

// Where the columns are; a fault for each that is not there.
template <std::size_t Count>
std::array<std::size_t, Count> places_of(const std::array<std::string_view, Count>& columns,
                                         std::string_view header, std::vector<Fault>& faults) {
  const std::vector<std::string_view> names = csv_cells(header);
  std::array<std::size_t, Count> places{};
  for (std::size_t c = 0; c < Count; ++c) {
    const auto at = std::find(names.begin(), names.end(), columns[c]);
    places[c] = static_cast<std::size_t>(at - names.begin());
    if (at == names.end())
      faults.push_back({fmt::format("/{}", columns[c]), fmt::format("there is no column {}", columns[c])});
  }
  return places;
}

// Nothing where a cell is empty; a fault where it is no number.
std::optional<Pose2> pose_in(std::string_view line, const std::array<std::size_t, 3>& places,
                             const std::string& row, std::vector<Fault>& faults) {
  const std::vector<std::string_view> cells = csv_cells(line);
  std::array<double, 3> values{};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string_view cell = places[c] < cells.size() ? cells[places[c]] : std::string_view();
    if (cell.empty()) return std::nullopt;
    const std::optional<double> value = csv_number(cell);
    if (!value) {
      faults.push_back({fmt::format("/{}/{}", row, kPose[c]), fmt::format("\"{}\" is no number", cell)});
      return std::nullopt;
    }
    values[c] = *value;
  }
  return Pose2{values[0], values[1], rad_from_deg(values[2])};
}

Result<std::optional<Pose2>> last_pose(const fs::path& path) {
  const auto bytes = read_data_file(path);
  if (!bytes) return fail(bytes.error());
  const std::vector<CsvLine> lines = csv_lines(*bytes);
  if (lines.size() < 2) return std::optional<Pose2>();
  std::vector<Fault> faults;
  const auto places = places_of(kPose, lines[0].text, faults);
  std::optional<Pose2> pose;
  if (faults.empty()) pose = pose_in(lines.back().text, places, std::to_string(lines.back().number), faults);
  if (!faults.empty())
    return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be read", path.string()),
                std::move(faults));
  return pose;
}

// The file of a drive, of its last leg that was begun.
std::optional<std::string> file_of(const json::MeasuredCampaign& campaign, const std::string& id,
                                   std::size_t legs) {
  if (const auto file = campaign.files.find(id); file != campaign.files.end()) return file->second;
  for (std::size_t leg = legs; leg > 0; --leg)
    if (const auto file = campaign.files.find(fmt::format("{}-leg{}", id, leg)); file != campaign.files.end())
      return file->second;
  return std::nullopt;
}

Result<campaign::MeasuredFinals> read_folder(const fs::path& folder, const campaign::DriveTable& table,
                                             std::span<const campaign::TableDrive> drives) {
  const auto bytes = read_data_file(folder / "campaign.json");
  if (!bytes) return fail(bytes.error());
  const auto measured = json::read_measured_campaign(*bytes);
  if (!measured) return fail(measured.error());
  campaign::MeasuredFinals finals;
  for (const campaign::TableDrive& drive : drives) {
    const auto file = file_of(*measured, drive.id, table.entries[drive.entry].legs.size());
    if (!file) continue;
    const auto pose = last_pose(folder / *file);
    if (!pose) return fail(pose.error());
    if (*pose) finals[drive.id] = **pose;
  }
  return finals;
}

Result<campaign::MeasuredFinals> read_survey(const fs::path& path) {
  const auto bytes = read_data_file(path);
  if (!bytes) return fail(bytes.error());
  const std::vector<CsvLine> lines = csv_lines(*bytes);
  std::vector<Fault> faults;
  const std::string_view header = lines.empty() ? std::string_view() : lines[0].text;
  const auto places = places_of(kPose, header, faults);
  const auto drive = places_of(std::array<std::string_view, 1>{"drive"}, header, faults);
  campaign::MeasuredFinals finals;
  for (std::size_t i = 1; faults.empty() && i < lines.size(); ++i) {
    const std::vector<std::string_view> cells = csv_cells(lines[i].text);
    const std::string row = std::to_string(lines[i].number);
    if (drive[0] >= cells.size()) continue;
    const auto pose = pose_in(lines[i].text, places, row, faults);
    if (pose && !finals.emplace(cells[drive[0]], *pose).second)
      faults.push_back({fmt::format("/{}/drive", row), fmt::format("{} is given twice", cells[drive[0]])});
  }
  if (!faults.empty())
    return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be read", path.string()),
                std::move(faults));
  return finals;
}

}  // namespace

Result<campaign::MeasuredFinals> read_measured_finals(const fs::path& path, const campaign::DriveTable& table,
                                                      std::span<const campaign::TableDrive> drives) {
  std::error_code ignored;
  return fs::is_directory(path, ignored) ? read_folder(path, table, drives) : read_survey(path);
}

}  // namespace slipway::api
