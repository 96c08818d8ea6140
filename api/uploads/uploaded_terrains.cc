#include "api/uploads/uploaded_terrains.h"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/utc.h"

namespace slipway::api {
namespace {

// "with --unit ft" -> "with \"unit\" ft".
std::string keys_for_flags(std::string text) {
  for (const std::string_view key : {"crs", "unit", "property", "legend", "soil", "fix"}) {
    const std::string flag = fmt::format("--{}", key), name = fmt::format("\"{}\"", key);
    for (std::size_t at = text.find(flag); at != std::string::npos; at = text.find(flag, at + name.size()))
      text.replace(at, flag.size(), name);
  }
  return text;
}

// "--legend" -> "/legend": who sends a request knows its keys.
Error in_words_of_request(Error error) {
  error.detail = keys_for_flags(std::move(error.detail));
  for (Fault& fault : error.faults) {
    if (fault.pointer.starts_with("--")) fault.pointer = "/" + fault.pointer.substr(2);
    fault.message = keys_for_flags(std::move(fault.message));
  }
  return error;
}

}  // namespace

Result<void> claim_terrain(const UploadFolder& uploads, TerrainOrder& order, const Asker& asker) {
  order.asker = asker;
  const std::filesystem::path place = uploads.terrains() / order.import.name;
  std::error_code error;
  if (!std::filesystem::exists(place, error) || may_change(read_origin(place), asker)) return {};
  return fail(
      ErrorCode::kConflict, "the terrain's name is taken",
      {{"/name",
        fmt::format("{} is the name of a terrain that somebody else made: choose another name, or ask "
                    "an administrator to replace it",
                    in_quotes(order.import.name))}});
}

Result<TerrainImportReport> take_terrain(UploadFolder& uploads, const TerrainOrder& order,
                                         const Catalogue& catalogue, Progress& progress) {
  TerrainImport import = order.import;
  import.data = uploads.root();
  auto map = uploads.verified(order.elevation, order.asker);
  if (!map) return fail(map.error());
  import.elevation = *std::move(map);
  for (const auto& [id, file] :
       {std::pair{&order.soil, &import.soil}, std::pair{&order.legend, &import.legend}}) {
    if (id->empty()) continue;
    auto path = uploads.verified(*id, order.asker);
    if (!path) return fail(path.error());
    *file = *std::move(path);
  }
  const auto elevation = uploads.find(order.elevation, order.asker);
  if (!elevation) return fail(ErrorCode::kNotFound, "the elevation map was deleted meanwhile");
  // What is written is about as large as what was sent, with its overviews half as large again.
  if (const auto room = uploads.check_room(elevation->bytes + elevation->bytes / 2); !room)
    return fail(room.error());
  const UploadOrigin origin{.owner = order.asker.name, .at_ms = now_ms(), .from = order.elevation};
  // A worker that died after the terrain was in its place does it again, too.
  const auto may_replace = [&order](const std::filesystem::path& there) {
    return may_change(read_origin(there), order.asker);
  };
  import.may_replace = may_replace;
  import.origin = origin_document(origin, import.name);
  auto report = import_terrain(import, catalogue, progress);
  if (!report) return fail(in_words_of_request(report.error()));
  return report;
}

}  // namespace slipway::api
