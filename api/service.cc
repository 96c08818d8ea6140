#include "api/service.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "api/files/model_folder.h"
#include "api/files/whole_file.h"
#include "api/uploads/uploaded_terrains.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;

// The finished folders under this one, and when each was made.
std::string folders_in(const fs::path& folder) {
  std::vector<std::string> entries;
  std::error_code error, gone;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (is_unfinished(entry.path())) continue;
    const auto written = fs::last_write_time(entry.path(), gone);
    if (!gone)
      entries.push_back(
          fmt::format("{} {}\n", entry.path().filename().string(), written.time_since_epoch().count()));
  }
  std::sort(entries.begin(), entries.end());
  std::string all;
  for (const std::string& entry : entries) all += entry;
  return all;
}

}  // namespace

Result<std::unique_ptr<Service>> Service::open(ServiceOptions options) {
  auto catalogue = load_catalogue(options.data, *options.soil_format);
  if (!catalogue) return fail(catalogue.error());
  if (!options.model.empty()) {
    const auto folder = load_model_folder(options.model);
    if (!folder) return fail(folder.error());
    catalogue = with_model(*std::move(catalogue), *folder, options.ground);
    if (!catalogue) return fail(catalogue.error());
  }
  std::unique_ptr<Service> service(new Service(std::move(options)));
  service->catalogue_ = std::make_shared<const Catalogue>(std::move(*catalogue));
  service->shipped_ = shipped_campaigns(service->options_.data, *service->catalogue_);
  return service;
}

std::shared_ptr<const Catalogue> Service::catalogue() const {
  if (!options_.uploads) return catalogue_;
  const std::string folders = folders_in(options_.uploads->terrains());
  const std::lock_guard lock(sent_mutex_);
  if (!with_sent_ || folders != sent_terrains_) {
    with_sent_ =
        folders.empty()
            ? catalogue_
            : std::make_shared<const Catalogue>(with_terrains(*catalogue_, options_.uploads->root()));
    sent_terrains_ = folders;
  }
  return with_sent_;
}

}  // namespace slipway::api
