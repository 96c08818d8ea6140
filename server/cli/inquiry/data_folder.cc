#include "server/cli/inquiry/data_folder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>
#include <utility>
#include <vector>

#include "core/version.h"
#include "server/cli/terminal/tables.h"

namespace slipway::server {
namespace {

namespace fs = std::filesystem;

// Every command needs these two; what else a folder lacks, the command that needs it says.
bool holds_data(const fs::path& folder) {
  std::error_code failed;
  return fs::is_directory(folder / "rovers", failed) && fs::is_directory(folder / "soils", failed);
}

// Without links and "..", where the folder can be resolved.
std::string plain(const fs::path& folder) {
  std::error_code failed;
  const fs::path resolved = fs::weakly_canonical(folder, failed);
  return (failed ? folder : resolved).string();
}

}  // namespace

Result<DataFolder> find_data_folder(const DataPlaces& places) {
  std::vector<Fault> looked_at;
  // A named folder is the user's choice: it is used as it was written, and nothing stands in for it.
  for (const auto& [name, folder] : {std::pair{"--data", places.option}, {"SLIPWAY_DATA", places.variable}}) {
    if (folder.empty()) {
      looked_at.push_back({name, "is not given"});
    } else if (holds_data(folder)) {
      return DataFolder{folder, name};
    } else {
      return fail(ErrorCode::kUnreadableData, fmt::format("{} names no data folder", name),
                  {{name, fmt::format("{} has no folders rovers and soils", folder)}});
    }
  }
  if (!places.executable.empty()) {
    const fs::path beside = places.executable.parent_path();
    for (const auto& [place, folder] : {std::pair{"beside the executable", beside / "data"},
                                        {"under the install prefix", beside / SLIPWAY_DATA_FROM_BIN}}) {
      if (holds_data(folder)) return DataFolder{plain(folder), fmt::format("looking {}", place)};
      looked_at.push_back({place, fmt::format("{} has no folders rovers and soils", plain(folder))});
    }
  }
  return fail(ErrorCode::kUnreadableData, "there is no data folder; name one by --data or SLIPWAY_DATA",
              std::move(looked_at));
}

DataPlaces data_places(const std::string& option) {
  const char* variable = std::getenv("SLIPWAY_DATA");
  std::error_code failed;
  return {.option = option,
          .variable = variable ? variable : "",
          .executable = fs::read_symlink("/proc/self/exe", failed)};
}

Result<std::string> data_folder(const std::string& option) {
  auto found = find_data_folder(data_places(option));
  if (!found) return fail(found.error());
  return std::move(found->path);
}

fs::path campaign_folder(const std::string& given, const std::string& data_option) {
  std::error_code error;
  const bool is_plain_name = !given.empty() && fs::path(given).filename() == given;
  if (!is_plain_name || fs::exists(fs::path(given) / "campaign.json", error)) return given;
  const auto data = data_folder(data_option);
  if (!data) return given;
  for (const char* const part : {"gap-practice", "drive-campaigns"})
    if (const fs::path shipped = fs::path(*data) / part / given; fs::exists(shipped / "campaign.json", error))
      return shipped;
  return given;
}

std::string left_out_text(const api::Catalogue& catalogue) {
  const std::vector<api::LeftOutFile>& files = catalogue.left_out;
  if (files.empty()) return {};
  if (files.size() > 1) {
    constexpr std::size_t kMostNamed = 5;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < std::min(files.size(), kMostNamed); ++i)
      names.push_back(fmt::format("{} {}", files[i].kind, files[i].name));
    return fmt::format("{} files of the data folder are left out: {}{}; \"slipway data check\" says why\n",
                       files.size(), fmt::join(names, ", "), files.size() > kMostNamed ? ", ..." : "");
  }
  const Fault& first = files.front().faults.front();
  std::string text = fmt::format("{} {} is left out: {}: {}", files.front().kind, files.front().name,
                                 first.pointer, first.message);
  if (files.front().faults.size() > 1)
    text += fmt::format(", and {} more faults", files.front().faults.size() - 1);
  return text + "; \"slipway data check\" lists them\n";
}

std::string version_text() {
  const auto found = find_data_folder(data_places(""));
  if (found) return fmt::format("{}\ndata: {} (found by {})", version(), found->path, found->found_by);
  return fmt::format("{}\ndata: none\n{}", version(), error_text(found.error()));
}

}  // namespace slipway::server
