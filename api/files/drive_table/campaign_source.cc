#include "api/files/drive_table/campaign_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <system_error>
#include <utility>

#include "api/files/drive_table/drive_table_file.h"
#include "api/files/soil_file.h"
#include "api/json/faults.h"
#include "core/digest.h"
#include "core/version.h"
#include "dem/geotiff.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;

fs::path shipped(const fs::path& data, const std::string& name) {
  return data / "campaigns" / (name + ".json");
}

Result<std::string> digest_of(const std::string& bytes, const campaign::DriveTable& table,
                              const fs::path& data) {
  const auto rover = read_data_file(data / "rovers" / (table.rover->name + ".json"));
  if (!rover) return fail(rover.error());
  std::uint64_t digest = fnv1a(build_id());
  digest = fnv1a(bytes, digest);
  digest = fnv1a(*rover, digest);
  std::set<std::string> soils;
  for (const campaign::TableTerrain& terrain : table.terrains) {
    for (const std::string& name : campaign::soils_of(terrain)) soils.insert(name);
    if (terrain.soil_map) {
      const auto classes =
          dem::encode_geotiff(*terrain.soil_map, campaign::class_elsewhere(terrain), terrain.crs_wkt);
      if (!classes) return fail(classes.error());
      digest = fnv1a(*classes, digest);
    }
    digest = fnv1a(terrain.ground->fingerprint(), digest);
    digest = fnv1a(terrain.crs_wkt, digest);
  }
  for (const std::string& name : soils) {
    json::Writer w;
    json::write_soil(w, table.soils.find(name)->second);
    digest = fnv1a(w.take(), digest);
  }
  return fmt::format("{:016x}", digest);
}

}  // namespace

std::vector<std::string> campaign_names(const fs::path& data) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(data / "campaigns", error), end; !error && it != end; it.increment(error))
    if (it->path().extension() == ".json") names.push_back(it->path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

Result<LoadedTable> load_campaign_table(const std::string& file_or_name, const fs::path& data,
                                        const Catalogue& catalogue) {
  std::error_code ignored;
  const fs::path own(file_or_name);
  const bool is_file = fs::is_regular_file(own, ignored);
  const std::vector<std::string> names = campaign_names(data);
  if (!is_file && std::find(names.begin(), names.end(), file_or_name) == names.end())
    return fail(ErrorCode::kNotFound,
                "there is no file of this name, and " + unknown_name("campaign", file_or_name, names));
  const fs::path path = is_file ? own : shipped(data, file_or_name);
  const auto bytes = read_data_file(path);
  if (!bytes) return fail(bytes.error());
  auto table = json::read_campaign_table(*bytes, path.parent_path(), catalogue);
  if (!table) return fail(std::move(table.error()));
  auto digest = digest_of(*bytes, *table, data);
  if (!digest) return fail(std::move(digest.error()));
  return LoadedTable{std::move(*table), std::move(*digest)};
}

}  // namespace slipway::api
