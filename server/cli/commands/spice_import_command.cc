#include "server/cli/commands/spice_import_command.h"

#include <fmt/format.h>

#include <utility>

#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/exit_status.h"
#include "server/cli/inquiry/kernel_files.h"
#include "server/cli/terminal/text_table.h"
#include "steps/slip_steps_csv.h"
#include "steps/steps_from_spice.h"

namespace slipway::server {
namespace {

std::string left_out_words(const steps::SpiceStepSummary& s) {
  TextTable table({"left out", "number", "because"});
  const auto add = [&table](std::string what, std::size_t number, std::string why) {
    if (number > 0) table.add({std::move(what), fmt::format("{}", number), std::move(why)});
  };
  add("segments", s.other_bodies, "of another body, centre or frame");
  add("segments", s.other_types, "of a type that is not read");
  add("states", s.without_attitude, "without an attitude");
  add("moves", s.gaps, "over a gap of more than 600 s");
  add("jumps", s.jumps_without_drive, "with no drive and rest before them");
  add("steps", s.too_short, "shorter than 0.45 m");
  add("steps", s.too_long, "longer than 2.2 m");
  add("steps", s.off_axis, "more than 14 deg off the body's axis");
  add("steps", s.no_slip, "with a ratio that is no slip");
  add("steps", s.out_of_range, "with a time or place that no table may have");
  add("steps", s.repeated, "which stand in several files");
  return table.print();
}

std::string import_words(const steps::SpiceSteps& found, const std::string& out) {
  const steps::SpiceStepSummary& s = found.summary;
  std::string words = fmt::format(
      "{} steps of sols {} to {}, {} of them with attitude, written to {}\n"
      "read: {} segments with {} states, {} segments of attitudes, {} sites, {}\n\n",
      s.steps, found.steps.front().sol, found.steps.back().sol, s.steps_with_attitude, out, s.rover_segments,
      s.states, s.attitude_segments, s.sites,
      s.has_landing_site ? "the landing site" : "no landing site: x_eqc_m and y_eqc_m stay empty");
  words += left_out_words(s);
  if (s.attitude_segments == 0)
    words +=
        "note: without attitudes a correction is told by its length and direction, and roll and heading stay "
        "empty\n";
  if (s.has_landing_site)
    words +=
        "note: x_eqc_m and y_eqc_m are summed from the landing site by the rover's own telemetry, which "
        "drifts: they are tens of metres off after some kilometres\n";
  return words;
}

}  // namespace

int import_spice(const SpiceImportCommand& options) {
  const auto files = KernelFiles::read(options.kernels);
  if (!files) return refuse_unreadable(files.error());
  const auto found = steps::steps_from_spice(files->kernels());
  if (!found) return refuse_unreadable(found.error());
  if (found->steps.empty())
    return refuse_unreadable({ErrorCode::kUnreadableData,
                              "the kernels have no step with a measured slip: nothing is written",
                              {{"/kernels", left_out_words(found->summary)}}});
  return deliver({{options.out, steps::write_slip_steps(found->steps)}}, import_words(*found, options.out));
}

}  // namespace slipway::server
