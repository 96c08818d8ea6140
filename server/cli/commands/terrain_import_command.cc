#include "server/cli/commands/terrain_import_command.h"

#include <csignal>

#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/inquiry/exit_status.h"
#include "server/cli/terminal/interruption.h"
#include "server/cli/terminal/terminal_progress.h"

namespace slipway::server {

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
  return deliver({}, options.json ? report->json : report->text);
}

}  // namespace slipway::server
