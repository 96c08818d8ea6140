#include "server/cli/commands/terrain_import_command.h"

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>

#include "api/files/terrain_site.h"
#include "api/files/whole_file.h"
#include "api/terrain_views/terrain_picture.h"
#include "dem/write/rgba_image.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/inquiry/exit_status.h"
#include "server/cli/terminal/interruption.h"
#include "server/cli/terminal/terminal_progress.h"

namespace slipway::server {
namespace {

// A small picture of what was made: its relief, in the colours of its soils where it has some. A terrain is
// one without it too.
void draw(const std::filesystem::path& folder, bool has_soils) {
  constexpr int kSide_px = 512;
  const auto site = api::TerrainSite::open(folder);
  if (!site) return;
  const dem::GridGeometry& grid = (*site)->info().geometry;
  const double width = grid.columns * grid.cell_x_m, height = grid.rows * grid.cell_y_m;
  const auto side = [&](double length) {
    return std::clamp(static_cast<int>(kSide_px * length / std::max(width, height)), 1, kSide_px);
  };
  api::TerrainPicture wanted{api::TerrainLayer::kHillshade, grid.extent(), side(width), side(height), ""};
  auto relief = api::draw_terrain(**site, wanted);
  if (!relief) return;
  wanted.layer = api::TerrainLayer::kSoil;
  const auto soils = has_soils ? api::draw_terrain(**site, wanted) : relief;
  for (std::size_t i = 0; has_soils && soils && i < relief->pixels.size(); ++i)
    for (std::size_t k = 0; k < 3 && soils->pixels[i][3] != 0; ++k)
      relief->pixels[i][k] = static_cast<std::uint8_t>((relief->pixels[i][k] + soils->pixels[i][k]) / 2);
  if (const auto png = dem::encode_png(*relief)) (void)api::write_whole_file(folder / "picture.png", *png);
}

}  // namespace

int import_terrain(const TerrainImportOptions& options) {
  std::signal(SIGTERM, [](int) { interrupt(); });  // as Ctrl-C: nothing is left behind
  const auto data = data_folder(options.data);
  if (!data) return refuse_unreadable(data.error());
  const auto catalogue = open_catalogue(options.data);
  if (!catalogue) return refuse_unreadable(catalogue.error());
  api::TerrainImport order = options.order;
  order.data = *data;
  if (!options.soil.empty()) order.soil = options.soil;
  if (!options.legend.empty()) order.legend = options.legend;
  if (options.map_coordinates) order.coordinates = dem::PolygonCoordinates::kMap;
  Result<api::TerrainImportReport> report;
  {
    TerminalProgress progress;
    report = api::import_terrain(order, *catalogue, progress);
  }
  if (!report) {
    const int status = refuse_unreadable(report.error());
    return report.error().code == ErrorCode::kUnsupportedCrs ? static_cast<int>(kBadInput) : status;
  }
  draw(report->folder, order.soil.has_value());
  return deliver({}, options.json ? report->json : report->text);
}

}  // namespace slipway::server
