#include "server/cli/inquiry/drive_choice.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>

namespace slipway::server {

using slipway::campaign::TableDrive;

Result<std::vector<TableDrive>> chosen_drives(const std::vector<TableDrive>& all,
                                              const std::vector<std::string>& only,
                                              const std::string& pointer) {
  if (only.empty()) return all;
  const auto fits = [](const std::string& pattern, const TableDrive& drive) {
    return fnmatch(pattern.c_str(), drive.id.c_str(), 0) == 0;
  };
  std::vector<Fault> faults;
  for (const std::string& pattern : only) {
    if (std::none_of(all.begin(), all.end(), [&](const TableDrive& d) { return fits(pattern, d); }))
      faults.push_back({pointer, fmt::format("{} fits no drive; the first is {}", pattern, all.front().id)});
  }
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, "unknown drives", std::move(faults));
  std::vector<TableDrive> drives;
  for (const TableDrive& drive : all)
    if (std::any_of(only.begin(), only.end(), [&](const std::string& p) { return fits(p, drive); }))
      drives.push_back(drive);
  return drives;
}

}  // namespace slipway::server
