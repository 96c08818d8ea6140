#include "server/cli/commands/data_check_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "api/files/catalogue.h"
#include "api/json/writer.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/inquiry/data_option.h"
#include "server/cli/inquiry/exit_status.h"

namespace slipway::server {
namespace {

// A terrain opens without its maps being read: those of its middle are read here.
void read_middles(api::Catalogue& catalogue) {
  for (auto it = catalogue.terrains.begin(); it != catalogue.terrains.end();) {
    constexpr double kHalfSide_cells = 100.0;
    const api::TerrainSite& site = *it->second;
    const dem::GridGeometry& geometry = site.info().geometry;
    const dem::Extent all = geometry.extent();
    const double x_m = 0.5 * (all.west_m + all.east_m), y_m = 0.5 * (all.south_m + all.north_m);
    const double half_x_m = kHalfSide_cells * geometry.cell_x_m,
                 half_y_m = kHalfSide_cells * geometry.cell_y_m;
    const auto middle = site.read({x_m - half_x_m, y_m - half_y_m, x_m + half_x_m, y_m + half_y_m});
    if (middle) {
      ++it;
      continue;
    }
    catalogue.left_out.push_back(
        {"terrain",
         it->first,
         {{fmt::format("terrains/{}/terrain.json#", it->first), middle.error().detail}}});
    it = catalogue.terrains.erase(it);
  }
}

std::string as_json(const std::string& data, const api::Catalogue& catalogue) {
  api::json::Writer w;
  w.begin_object().text("format", "data-check/1").text("data", data);
  w.texts("rovers", api::names_of(catalogue.rovers)).texts("soils", api::names_of(catalogue.soils));
  w.texts("rules", api::names_of(catalogue.rules)).texts("terrains", api::names_of(catalogue.terrains));
  w.key("left_out").begin_array();
  for (const api::LeftOutFile& file : catalogue.left_out) {
    w.begin_object().text("kind", file.kind).text("name", file.name);
    w.key("faults").begin_array();
    for (const Fault& fault : file.faults)
      w.begin_object().text("pointer", fault.pointer).text("message", fault.message).end_object();
    w.end_array().end_object();
  }
  w.end_array().end_object();
  return w.take() + "\n";
}

std::string as_text(const std::string& data, const api::Catalogue& catalogue) {
  std::string text = fmt::format("{}: {} rovers, {} soils, {} sets of rules and {} terrains can be used\n",
                                 data, catalogue.rovers.size(), catalogue.soils.size(),
                                 catalogue.rules.size(), catalogue.terrains.size());
  for (const api::LeftOutFile& file : catalogue.left_out) {
    text += fmt::format("left out: {} {}\n", file.kind, file.name);
    for (const Fault& fault : file.faults) text += fmt::format("  {}: {}\n", fault.pointer, fault.message);
  }
  return text;
}

}  // namespace

int check_data(const DataCheckOptions& options) {
  const auto data = data_folder(options.data);
  if (!data) return refuse_unreadable(data.error());
  auto catalogue = api::load_catalogue(*data);
  if (!catalogue) return refuse_unreadable(catalogue.error());
  read_middles(*catalogue);
  const int status = deliver({}, options.json ? as_json(*data, *catalogue) : as_text(*data, *catalogue));
  return status == kDone && !catalogue->left_out.empty() ? kBadInput : status;
}

void add_data_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<DataCheckOptions>();
  CLI::App* const data = app.add_subcommand("data", "the folder of rovers, soils, rules and terrains");
  data->require_subcommand(1);
  CLI::App* const check = data->add_subcommand(
      "check", "read every file of the data folder: those with faults are listed, and no command uses them");
  add_data_option(*check, options->data, "rovers, soils, rules and terrains");
  check->add_flag("--json", options->json, "print JSON (data-check/1)");
  check->footer(
      "Example:\n  slipway data check --data my_data\nExit status: 0 all are good, 2 some are left out");
  check->callback([options, &run] { run = [options] { return check_data(*options); }; });
}

}  // namespace slipway::server
