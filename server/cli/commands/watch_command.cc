#include "server/cli/commands/watch_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <string>
#include <vector>

#include "api/documents/diagnosis/watch_document.h"
#include "api/report/watch_report.h"
#include "gap/diagnosis/drive_watch.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/exit_status.h"
#include "server/cli/terminal/terminal_progress.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {
namespace {

std::string diagnosis_words(const gap::DriveWatch& watch) {
  const gap::Diagnosis& d = *watch.diagnosis;
  std::vector<std::string> effects;
  for (const gap::FoundEffect& e : d.effects)
    effects.push_back(fmt::format("{} (probability {:.2f})", e.name, e.probability));
  return fmt::format("diagnosis of the drives from {} on: {}{}{}\n{}\n",
                     watch.drives[watch.diagnosed_since].id, gap::name_of(d.verdict),
                     effects.empty() ? "" : ": ", fmt::join(effects, ", "), d.reason);
}

std::string watch_words(const gap::DriveWatch& watch) {
  std::string out = fmt::format("{}: {} drives were taken as healthy ({}), {} watched\n", watch.campaign,
                                watch.learnt_drives, watch.reference, watch.drives.size());
  out += fmt::format(
      "an alarm is raised where the evidence of a change stands at {:g} to 1 at two drives running: while "
      "nothing changes that ever happens with a probability of at most {:g}\n",
      1.0 / watch.alpha, watch.alpha);
  TextTable table({"drive", "log10 evidence", "share of the onset", ""});
  for (std::size_t d = 0; d < watch.drives.size(); ++d) {
    std::string mark;
    if (watch.alarm && d == watch.since) mark = "most probably changed since here";
    if (watch.alarm == d) mark += mark.empty() ? "alarm" : ", alarm";
    table.add({watch.drives[d].id, fmt::format("{:.2f}", watch.drives[d].log10_evidence),
               d < watch.onset_shares.size() ? fmt::format("{:.2f}", watch.onset_shares[d]) : "", mark});
  }
  out += table.print();
  for (const std::string& note : watch.notes) out += fmt::format("note: {}\n", note);
  out += api::change_words(watch) + "\n";
  if (!watch.alarm) return out;
  out += fmt::format("{}\n{}\n", api::first_pointer_words(watch), api::deciding_words(watch));
  return watch.diagnosis ? out + diagnosis_words(watch) : out;
}

}  // namespace

int watch(const WatchCommand& options) {
  if (options.campaign.ends_with(".csv")) return watch_steps(options);
  const auto drives = load_drives(options);
  if (!drives) return refuse_unreadable(drives.error());
  const auto& [campaign, reference] = *drives;
  // What can't be written is known before the work.
  if (!options.report.empty())
    if (const auto made = make_room_for_report(options.report); !made) return refuse(made.error());
  gap::WatchOptions watch;
  watch.learn = options.learn;
  watch.change.alpha = options.alpha;
  watch.diagnose = options.diagnose;
  std::optional<Result<gap::DriveWatch>> result;
  {
    TerminalProgress progress;
    result =
        gap::watch_drives(campaign, reference ? &*reference : nullptr, watch, options.search(), progress);
  }
  if (!*result) return refuse((*result).error());
  const gap::DriveWatch& found = **result;
  std::vector<OutputFile> files;
  if (!options.report.empty()) {
    const std::vector<api::NamedChart> charts = api::draw_watch(found);
    files = report_output(options.report, api::watch_report(campaign, found, charts), charts, "watch.json",
                          api::json::watch_document(found));
  }
  const int status = deliver(files, options.json ? api::json::watch_document(found) : watch_words(found));
  if (status != kDone) return status;
  if (found.silent_drives() == found.drives.size()) return kFailed;
  return found.alarm ? kChanged : kDone;
}

}  // namespace slipway::server
