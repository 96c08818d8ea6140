#include "api/terrain_views/terrain_document.h"

#include <fmt/format.h>

#include <optional>
#include <string_view>

#include "api/documents/catalogue_documents.h"
#include "api/json/writer.h"
#include "api/terrain_views/terrain_layer.h"
#include "api/terrain_views/terrain_picture.h"
#include "core/sha256.h"

namespace slipway::api {
namespace {

using json::Writer;

void write_text(Writer& w, std::string_view key, const std::optional<std::string>& text) {
  w.key(key);
  if (text) {
    w.text(*text);
  } else {
    w.null();
  }
}

void write_layer_legend(Writer& w, const TerrainLayerRow& row, const Legend& legend) {
  w.begin_array();
  for (const LayerLegendEntry& entry : legend_of(row, legend)) {
    w.begin_object().text("label", entry.label).key("colour");
    if (entry.colour) {
      w.text(fmt::format("#{:02x}{:02x}{:02x}", (*entry.colour)[0], (*entry.colour)[1], (*entry.colour)[2]));
    } else {
      w.null();
    }
    w.end_object();
  }
  w.end_array();
}

// With the colours of every legend of the terrain's where they differ.
void write_layer(Writer& w, const TerrainLayerRow& row, const TerrainSite& site) {
  w.begin_object().text("name", row.name).text("title", row.title).text("unit", row.unit);
  w.whole("min_z", 0).key("legends").begin_array();
  for (const Legend& legend : site.description().legends) {
    w.begin_object().text("legend", legend.name).key("entries");
    write_layer_legend(w, row, legend);
    w.end_object();
    if (!row.of_soil) break;
  }
  w.end_array().end_object();
}

}  // namespace

std::string hash_of(const std::vector<TerrainFile>& files) {
  Sha256 hash;
  for (const TerrainFile& file : files) hash.add(fmt::format("{}\n{}\n", file.name, file.sha256));
  return hash.digest();
}

Result<std::string> write_terrain_document(const TerrainSite& site, const std::vector<TerrainFile>& files) {
  const auto provenance = site.text_of(site.description().provenance_file);
  if (!provenance) return fail(provenance.error());
  const auto licence = site.text_of(kLicenceFile);
  if (!licence) return fail(licence.error());
  const std::string& name = site.description().name;
  const std::string hash = hash_of(files);
  Writer w;
  w.begin_object().key("terrain");
  json::write_terrain(w, site);
  w.text("hash", hash).key("files").begin_array();
  for (const TerrainFile& file : files) {
    w.begin_object().text("file", file.name).whole("bytes", static_cast<std::int64_t>(file.bytes));
    w.text("sha256", file.sha256).end_object();
  }
  w.end_array();
  write_text(w, "provenance", *provenance);
  write_text(w, "licence", *licence);
  const TerrainTiles tiles(site.info().geometry);
  w.key("layers").begin_array();
  for (const TerrainLayerRow& row : kTerrainLayers) write_layer(w, row, site);
  w.end_array();
  const dem::Extent map = site.info().geometry.extent();
  w.key("tiles").begin_object();
  w.text("address", fmt::format("/v1/terrains/{}/tiles/{{layer}}/{{z}}/{{x}}/{{y}}.png?v={}", name, hash));
  w.whole("tile_px", TerrainTiles::kTilePx).exact("west_m", map.west_m).exact("north_m", map.north_m);
  w.key("metres_per_px").begin_array();
  for (int z = 0; z <= tiles.most_z(); ++z) w.exact(tiles.metres_per_px(z));
  w.end_array().end_object();
  w.key("pictures").begin_object();
  w.text("address", fmt::format("/v1/terrains/{}/{{layer}}.png?v={}", name, hash));
  w.whole("max_px", kMaxPicturePx).end_object();
  w.end_object();
  return w.take();
}

}  // namespace slipway::api
