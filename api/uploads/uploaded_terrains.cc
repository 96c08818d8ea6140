#include "api/uploads/uploaded_terrains.h"

#include <filesystem>
#include <utility>

#include "core/utc.h"

namespace slipway::api {
namespace {

// "--legend" -> "/legend": who sends a request knows its keys.
Error in_words_of_request(Error error) {
  for (Fault& fault : error.faults)
    if (fault.pointer.starts_with("--")) fault.pointer = "/" + fault.pointer.substr(2);
  return error;
}

}  // namespace

Result<TerrainImportReport> take_terrain(UploadFolder& uploads, const TerrainOrder& order,
                                         const Catalogue& catalogue, Progress& progress) {
  TerrainImport import = order.import;
  import.data = uploads.root();
  auto map = uploads.verified(order.elevation);
  if (!map) return fail(map.error());
  import.elevation = *std::move(map);
  for (const auto& [id, file] :
       {std::pair{&order.soil, &import.soil}, std::pair{&order.legend, &import.legend}}) {
    if (id->empty()) continue;
    auto path = uploads.verified(*id);
    if (!path) return fail(path.error());
    *file = *std::move(path);
  }
  const auto elevation = uploads.find(order.elevation);
  if (!elevation) return fail(ErrorCode::kNotFound, "the elevation map was deleted meanwhile");
  // What is written is about as large as what was sent, with its overviews half as large again.
  if (const auto room = uploads.check_room(elevation->bytes + elevation->bytes / 2); !room)
    return fail(room.error());
  const UploadOrigin origin{.owner = elevation->origin.owner, .at_ms = now_ms(), .from = order.elevation};
  // A worker that died after the terrain was in its place does it again.
  const auto before = read_origin(uploads.terrains() / import.name);
  import.replace = before && before->from == origin.from;
  import.origin = origin_document(origin, import.name);
  auto report = import_terrain(import, catalogue, progress);
  if (!report) return fail(in_words_of_request(report.error()));
  return report;
}

}  // namespace slipway::api
