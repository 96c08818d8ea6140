#include "server/cli/watch_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "api/documents/watch_document.h"
#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/catalogue.h"
#include "gap/diagnosis/drive_watch.h"
#include "server/cli/command_parts.h"
#include "server/cli/exit_status.h"
#include "server/cli/terminal/terminal_progress.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {
namespace {

constexpr std::size_t kMaxCauses = 4;

std::string diagnosis_words(const gap::Diagnosis& d) {
  std::vector<std::string> effects;
  for (const gap::FoundEffect& e : d.effects)
    effects.push_back(fmt::format("{} (probability {:.2f})", e.name, e.probability));
  std::string out = fmt::format("diagnosis of the drives since then: {}{}{}\n", gap::name_of(d.verdict),
                                effects.empty() ? "" : ": ", fmt::join(effects, ", "));
  return out + d.reason + "\n";
}

std::string watch_words(const gap::DriveWatch& watch) {
  std::string out = fmt::format("{}: {} drives were taken as healthy ({}), {} watched\n", watch.campaign,
                                watch.learnt_drives, watch.reference, watch.drives.size());
  out += fmt::format(
      "an alarm is raised where the evidence of a change stands at {:g} to 1 at two drives running: while "
      "nothing changes that ever happens with a probability of at most {:g}\n",
      1.0 / watch.alpha, watch.alpha);
  TextTable table({"drive", "log10 evidence", ""});
  for (std::size_t d = 0; d < watch.drives.size(); ++d) {
    std::string mark;
    if (watch.alarm && d == watch.since) mark = "changed since here";
    if (watch.alarm == d) mark += mark.empty() ? "alarm" : ", alarm";
    table.add({watch.drives[d].id, fmt::format("{:.2f}", watch.drives[d].log10_evidence), mark});
  }
  out += table.print();
  if (!watch.alarm) return out + "nothing has changed as far as these drives show\n";
  std::vector<std::string> causes;
  for (std::size_t i = 0; i < std::min(kMaxCauses, watch.causes.size()); ++i)
    causes.push_back(fmt::format("{} {:.2f}", watch.causes[i].name, watch.causes[i].share));
  out += fmt::format("something has changed: alarm at drive {}, most probably since {} ({} drives)\n",
                     watch.drives[*watch.alarm].id, watch.drives[watch.since].id,
                     *watch.alarm - watch.since + 1);
  out += fmt::format("first pointer, by derivatives alone and without causes from outside: {}\n",
                     fmt::join(causes, ", "));
  if (watch.diagnosis)
    out += "the diagnosis of the drives since, which decides:\n" + diagnosis_words(*watch.diagnosis);
  return out;
}

}  // namespace

int watch(const WatchCommand& options) {
  const auto catalogue = open_catalogue(options.data);
  if (!catalogue) return refuse_unreadable(catalogue.error());
  const auto campaign = api::load_drive_campaign(options.campaign, *catalogue);
  if (!campaign) return refuse_unreadable(campaign.error());
  const auto reference = api::load_reference_drives(options.reference, *catalogue);
  if (!reference) return refuse_unreadable(reference.error());
  gap::WatchOptions watch;
  watch.learn = options.learn;
  watch.change.alpha = options.alpha;
  watch.diagnose = options.diagnose;
  gap::DiagnosisOptions diagnosis;
  diagnosis.search.withheld = options.without;
  diagnosis.search.threads = static_cast<std::size_t>(options.threads);
  diagnosis.seed = options.seed;
  std::optional<Result<gap::DriveWatch>> result;
  {
    TerminalProgress progress;
    result = gap::watch_drives(*campaign, *reference ? &**reference : nullptr, watch, diagnosis, progress);
  }
  if (!*result) return refuse((*result).error());
  const gap::DriveWatch& found = **result;
  const int status = deliver({}, options.json ? api::json::watch_document(found) : watch_words(found));
  return status != kDone ? status : found.alarm ? kChanged : kDone;
}

}  // namespace slipway::server
