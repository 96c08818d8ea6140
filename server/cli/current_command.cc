#include "server/cli/current_command.h"

#include <fmt/format.h>

#include <vector>

#include "api/documents/current_documents.h"
#include "api/report/current_maps_output.h"
#include "api/requests/current_inversion.h"
#include "api/requests/current_maps.h"
#include "api/service.h"
#include "core/angle.h"
#include "server/cli/command_parts.h"
#include "server/cli/inquiry/data_folder.h"

namespace slipway::server {
namespace {

constexpr std::size_t kSamplesAlongX = 61, kLinesOverY = 5;

Result<api::CurrentMaps> maps_of(const api::Catalogue& catalogue, const CurrentMapCommand& command) {
  api::CurrentMapOptions options;
  options.rover = command.rover;
  options.load_n = command.load_n;
  options.gravity_m_s2 = command.gravity_m_s2;
  options.slip = command.slip;
  options.model = command.model == "balanced" ? sim::CurrentModel::kBalanced : sim::CurrentModel::kLiteral;
  if (command.figure) return api::current_figure(catalogue, options, *command.figure);
  std::vector<sim::SweepAxis> axes;
  const auto x = sweep_axis_of(command.x, kSamplesAlongX, "x");
  if (!x) return fail(x.error());
  axes.push_back(*x);
  if (!command.y.empty()) {
    const auto y = sweep_axis_of(command.y, kLinesOverY, "y");
    if (!y) return fail(y.error());
    axes.push_back(*y);
  }
  return api::current_map(catalogue, options, command.soil, axes);
}

std::string words_of(const api::CurrentInversion& inversion) {
  const sim::CurrentInverse& answer = inversion.answer;
  const api::CurrentInversionRequest& request = inversion.request;
  std::string out =
      fmt::format("{:.3f} A of wheel {} of {} under {:.1f} N on {}: {}\n", request.current_a, request.wheel,
                  request.rover, request.load_n.value_or(0.0), request.soil, sim::describe(answer.verdict));
  for (const std::string& reason : answer.words) out += fmt::format("  - {}\n", reason);
  if (answer.found.reported) out += fmt::format("slip               {:.3f}", *answer.found.reported);
  if (const sim::SlipQuantiles& q = answer.quantiles; answer.found.reported && q.solved > 0)
    out += fmt::format(
        "   (5, 50, 95 % of {} soil draws: {:.3f}, {:.3f}, {:.3f}; {} draws ask for less current "
        "at any slip, {} for more)",
        q.draws, q.p05, q.p50, q.p95, q.above, q.below);
  if (answer.found.reported) out += "\n";
  if (answer.wheel)
    out += fmt::format("sinkage            {:.1f} mm\ndrawbar pull       {:.1f} N\n",
                       1e3 * answer.wheel->sinkage_m, answer.wheel->forces.drawbar_pull_n);
  if (answer.greatest)
    out += fmt::format("greatest pull      {:.1f} N at slip {:.2f}\n", answer.greatest->pull_n,
                       answer.greatest->slip);
  if (answer.share_of_pull)
    out += fmt::format("pull in use        {:.0f} %\n", 100.0 * *answer.share_of_pull);
  if (answer.slope_in_use_rad)
    out += fmt::format("slope              {:.1f} deg in use, {:.1f} deg at most, {:.1f} deg left\n",
                       deg_from_rad(*answer.slope_in_use_rad), deg_from_rad(*answer.slope_greatest_rad),
                       deg_from_rad(*answer.slope_left_rad));
  return out;
}

}  // namespace

int current_map(const CurrentMapCommand& options) {
  const auto catalogue = open_catalogue(options.ask.data);
  if (!catalogue) return refuse(catalogue.error());
  const auto maps = maps_of(*catalogue, options);
  if (!maps) return refuse(maps.error());
  const std::string csv = api::current_maps_csv(*maps);
  std::vector<OutputFile> files;
  if (!options.csv.empty()) files.push_back({options.csv, csv});
  if (!options.plot.empty()) files.push_back({options.plot, api::draw_current_maps(*maps)});
  std::string printed;
  if (options.ask.json) {
    printed = api::json::write_current_maps(*maps) + "\n";
  } else if (options.csv.empty()) {
    printed = csv;
  }
  return deliver(files, printed);
}

int current_invert(const CurrentInvertCommand& options) {
  const auto data = data_folder(options.ask.data);
  if (!data) return refuse(data.error());
  const auto service = api::Service::open({.data = *data});
  if (!service) return refuse(service.error());
  api::CurrentInversionRequest request;
  request.rover = options.rover;
  request.wheel = options.wheel;
  request.soil = options.soil;
  request.current_a = options.current_a;
  request.load_n = options.load_n;
  request.gravity_m_s2 = options.gravity_m_s2;
  request.speed_m_s = options.speed_m_s;
  request.motor_temp_c = options.motor_temp_c;
  for (const std::string& setting : options.effects) {
    const auto effect = effect_of(setting);
    if (!effect) return refuse(effect.error());
    request.effects.push_back(*effect);
  }
  request.options.max_slip = options.max_slip;
  request.options.draws = options.draws;
  request.options.seed = options.seed;
  const auto inversion = api::invert_current(*(*service)->catalogue(), request);
  if (!inversion) return refuse(inversion.error());
  return deliver(
      {}, options.ask.json ? api::json::write_current_inversion(*inversion) + "\n" : words_of(*inversion));
}

}  // namespace slipway::server
