#include <fmt/format.h>

#include "api/files/slip_steps_file.h"
#include "api/json/writer.h"
#include "api/steps/step_comparison.h"
#include "server/cli/commands/watch_command.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/exit_status.h"
#include "steps/ground_watch.h"

namespace slipway::server {
namespace {

// A stretch with its sol, and its first step in the table.
struct Alarm {
  int sol = 0;
  std::size_t row = 0;
  steps::LooseStretch stretch;
};

std::string document(const std::vector<steps::SlipStep>& table, const std::vector<Alarm>& alarms) {
  api::json::Writer w;
  w.begin_object().text("format", "steps-watch/1").whole("steps", static_cast<std::int64_t>(table.size()));
  w.key("alarms").begin_array();
  for (const Alarm& alarm : alarms) {
    const steps::SlipStep& step = table[alarm.row];
    w.begin_object().whole("sol", alarm.sol).text("cause", "soft_patch");
    w.whole("first_step", static_cast<std::int64_t>(alarm.stretch.first) + 1);
    w.whole("last_step", static_cast<std::int64_t>(alarm.stretch.last) + 1);
    if (step.x_eqc_m && step.y_eqc_m) w.metres("x_m", *step.x_eqc_m).metres("y_m", *step.y_eqc_m);
    w.significant("probability", alarm.stretch.probability);
    w.significant("largest_slip", alarm.stretch.largest_slip);
    w.significant("usual_slip", alarm.stretch.usual_slip).end_object();
  }
  w.end_array().end_object();
  return w.take() + "\n";
}

std::string words(const std::vector<steps::SlipStep>& table, const std::vector<Alarm>& alarms) {
  std::string out =
      fmt::format("{} measured steps of sols {} to {}\n", table.size(), table.front().sol, table.back().sol);
  for (const Alarm& alarm : alarms) {
    const steps::SlipStep& step = table[alarm.row];
    out += fmt::format(
        "sol {}, steps {} to {}{}: a soft patch (probability {:.3f}): slip up to {:.2f} where firm ground "
        "has "
        "{:.2f}\n",
        alarm.sol, alarm.stretch.first + 1, alarm.stretch.last + 1,
        step.x_eqc_m && step.y_eqc_m ? fmt::format(" at ({:.1f}, {:.1f})", *step.x_eqc_m, *step.y_eqc_m) : "",
        alarm.stretch.probability, alarm.stretch.largest_slip, alarm.stretch.usual_slip);
  }
  out += alarms.empty()
             ? "no sol came onto loose ground\n"
             : "the ground changed there, not the rover: the slip of the whole rover tells no wheel\n";
  return out;
}

}  // namespace

int watch_steps(const WatchCommand& options) {
  const auto table = api::read_slip_steps_file(options.campaign, options.campaign);
  if (!table) return refuse_unreadable(table.error());
  const auto catalogue = open_catalogue(options.data);
  if (!catalogue) return refuse_unreadable(catalogue.error());
  const auto rover = api::rover_that_made_steps(*catalogue, options.rover);
  if (!rover) return refuse_unreadable(rover.error());
  const sim::SoilDistribution* const belief =
      &catalogue->soils.find(api::unknown_ground_at(api::kMarsGravity_m_s2))->second;
  const steps::GroundChain chain(**rover, api::kMarsGravity_m_s2, std::span(&belief, 1));
  steps::GroundWatch watch(chain);
  std::vector<Alarm> alarms;
  std::size_t row = 0;
  for (const std::vector<steps::ChainStep>& way : api::ways_of(*table)) {
    for (const steps::LooseStretch& stretch : watch.next_sol(way))
      alarms.push_back({(*table)[row].sol, row + stretch.first, stretch});
    row += way.size();
  }
  const int written = deliver({}, options.json ? document(*table, alarms) : words(*table, alarms));
  return written != 0 || alarms.empty() ? written : kChanged;
}

}  // namespace slipway::server
