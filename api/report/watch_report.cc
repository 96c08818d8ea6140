#include "api/report/watch_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/report/diagnosis_charts.h"
#include "api/report/diagnosis_report.h"
#include "api/report/diagnosis_sections.h"
#include "api/report/gap_report.h"
#include "api/report/report_words.h"
#include "core/version.h"

namespace slipway::api {
namespace {

using gap::DriveWatch;

constexpr std::size_t kMaxCauses = 4;       // of the first pointer, in words
constexpr std::size_t kMaxNamedTicks = 25;  // drives whose names have room under a chart

std::vector<gap::ChangeShare> likeliest_causes(const DriveWatch& watch) {
  return {watch.causes.begin(),
          watch.causes.begin() + static_cast<std::ptrdiff_t>(std::min(kMaxCauses, watch.causes.size()))};
}

// "D030", or "one of D028 to D031 (93 % of the evidence at the alarm), most probably D030".
std::string onset_words(const DriveWatch& watch) {
  const std::string& likeliest = watch.drives[watch.since].id;
  const std::string share = fmt::format("({:.0f} % of the evidence at the alarm)", 100.0 * watch.onset.share);
  if (watch.onset.first == watch.onset.last) return fmt::format("{} {}", likeliest, share);
  return fmt::format("one of {} to {} {}, most probably {}", watch.drives[watch.onset.first].id,
                     watch.drives[watch.onset.last].id, share, likeliest);
}

// An axis of drives: their names where there is room, else their numbers from 1.
bool has_named_ticks(const DriveWatch& watch) {
  return watch.drives.size() <= kMaxNamedTicks;
}
double place_of(const DriveWatch& watch, std::size_t drive) {
  return static_cast<double>(drive) + (has_named_ticks(watch) ? 0.0 : 1.0);
}
ChartAxis drive_axis(const DriveWatch& watch) {
  ChartAxis axis;
  axis.title = has_named_ticks(watch) ? "drives in their order" : "drives by their number in order, from 1";
  if (!has_named_ticks(watch)) return axis;
  for (const gap::WatchedDrive& drive : watch.drives) axis.categories.push_back(drive.id);
  return axis;
}

Chart chart_over_drives(const DriveWatch& watch, std::string title, std::string of) {
  Chart chart;
  chart.title = std::move(title);
  chart.x = drive_axis(watch);
  chart.y.title = std::move(of);
  return chart;
}

Chart evidence_chart(const DriveWatch& watch) {
  Chart chart =
      chart_over_drives(watch, "Evidence of a change up to each drive", "decimal logarithm of the evidence");
  const double limit = -std::log10(watch.alpha);
  ChartSeries evidence{.name = "evidence", .mark = ChartMark::kLineAndPoints, .x = {}, .y = {}, .colour = 0};
  double lowest = 0.0, highest = limit;
  for (std::size_t d = 0; d < watch.drives.size(); ++d) {
    const double value = watch.drives[d].log10_evidence;
    evidence.x.push_back(place_of(watch, d));
    evidence.y.push_back(value);
    if (!std::isfinite(value)) continue;
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  chart.series = {std::move(evidence),
                  {fmt::format("limit of an alarm ({:g} to 1, at two drives running)", 1.0 / watch.alpha),
                   ChartMark::kDashedLine,
                   {place_of(watch, 0), place_of(watch, watch.drives.size() - 1)},
                   {limit, limit},
                   6}};
  if (!watch.alarm) return chart;
  const double alarm = place_of(watch, *watch.alarm);
  chart.series.push_back(
      {"alarm", ChartMark::kPoints, {alarm}, {watch.drives[*watch.alarm].log10_evidence}, 1});
  constexpr double kHalf = 0.4;  // of the step from drive to drive
  chart.bands.push_back(
      {fmt::format("onset ({:.0f} % of the evidence)", 100.0 * watch.onset.share),
       {place_of(watch, watch.onset.first) - kHalf, place_of(watch, watch.onset.last) + kHalf},
       {lowest, lowest},
       {highest, highest},
       3});
  return chart;
}

Chart onset_chart(const DriveWatch& watch) {
  Chart chart = chart_over_drives(watch, "Which drive is the first that differs",
                                  "share of the evidence at the alarm, %");
  chart.y.lowest = 0.0;
  ChartSeries shares{
      .name = "share of the onset", .mark = ChartMark::kLineAndPoints, .x = {}, .y = {}, .colour = 3};
  for (std::size_t d = 0; d < watch.onset_shares.size(); ++d) {
    shares.x.push_back(place_of(watch, d));
    shares.y.push_back(100.0 * watch.onset_shares[d]);
  }
  chart.series = {std::move(shares)};
  return chart;
}

void write_drives(ReportPage& page, const DriveWatch& watch) {
  page.folded_table("Every drive in numbers",
                    {"drive", "windows", "log10 of the evidence", "share of the onset", "alarm"});
  for (std::size_t d = 0; d < watch.drives.size(); ++d)
    page.row({watch.drives[d].id, std::to_string(watch.drives[d].windows),
              number_words("{:.2f}", watch.drives[d].log10_evidence),
              d < watch.onset_shares.size() ? fmt::format("{:.1f} %", 100.0 * watch.onset_shares[d]) : "",
              watch.drives[d].alarm ? "yes" : "no"});
}

void write_first_pointer(ReportPage& page, const DriveWatch& watch) {
  page.section("A first pointer, which is no diagnosis");
  page.paragraph(
      "What the change looks like at the moment of the alarm, by derivatives alone and without causes from "
      "outside:");
  page.table({"what could have changed", "share of the evidence at the alarm", "what it is"});
  for (const gap::ChangeShare& cause : likeliest_causes(watch))
    page.row({cause.name, fmt::format("{:.0f} %", 100.0 * cause.share), effect_summary(cause.name)});
  page.paragraph(deciding_words(watch) + ".");
}

}  // namespace

std::string change_words(const DriveWatch& watch) {
  const std::size_t silent = watch.silent_drives();
  if (silent == watch.drives.size())
    return "nothing can be said: no drive has a window of use (two rows with position and attitude, on the "
           "terrain)";
  if (watch.awaits_another())
    return fmt::format(
        "at {} the evidence of a change stands above the limit: another drive, that is no repeat, must "
        "confirm "
        "it before an alarm is raised",
        watch.drives.back().id);
  if (!watch.alarm)
    return fmt::format("nothing has changed as far as these drives show{}",
                       silent == 0 ? "" : fmt::format(" ({} of them have no window of use)", silent));
  return fmt::format(
      "something has changed: the first drive that differs is {}; the alarm was raised at {} ({} drives from "
      "the most probable one on)",
      onset_words(watch), watch.drives[*watch.alarm].id, *watch.alarm - watch.since + 1);
}

std::string first_pointer_words(const DriveWatch& watch) {
  if (!watch.alarm) return {};
  std::vector<std::string> causes;
  for (const gap::ChangeShare& cause : likeliest_causes(watch))
    causes.push_back(fmt::format("{} {:.2f}", cause.name, cause.share));
  return fmt::format(
      "first pointer, which is no diagnosis: at the moment of the alarm the change looks like {} (shares of "
      "the evidence, by derivatives alone and without causes from outside)",
      fmt::join(causes, ", "));
}

std::string deciding_words(const DriveWatch& watch) {
  if (!watch.alarm) return {};
  if (!watch.diagnosis) return "No diagnosis was made, and the first pointer does not stand in for one";
  return fmt::format(
      "The answer is the diagnosis of the drives from {} on; where it differs from the first pointer, the "
      "diagnosis counts",
      watch.drives[watch.diagnosed_since].id);
}

std::vector<NamedChart> draw_watch(const DriveWatch& watch) {
  std::vector<Chart> panels{evidence_chart(watch)};
  if (watch.alarm) panels.push_back(onset_chart(watch));
  std::vector<NamedChart> charts{
      {"evidence", draw_charts(fmt::format("{}: has anything changed?", watch.campaign), panels)}};
  if (!watch.diagnosis) return charts;
  for (NamedChart& chart : draw_diagnosis(*watch.diagnosed, *watch.diagnosis))
    charts.push_back(std::move(chart));
  return charts;
}

ReportPage watch_report(const gap::DriveCampaign& campaign, const DriveWatch& watch,
                        const std::vector<NamedChart>& charts) {
  using Style = ReportText::Style;
  ReportPage page(fmt::format("Watch of {}", watch.campaign));
  write_what_was_driven(page, campaign);
  page.paragraph(std::vector<ReportText::Span>{{change_words(watch), Style::kStrong}, {"."}});
  page.paragraph(fmt::format(
      "{} drives of {} were taken as healthy, and {} were watched in their order. An alarm is raised where "
      "the "
      "evidence of a change stands at {:g} to 1 at two drives running: while nothing changes, that ever "
      "happens with a probability of at most {:g}.",
      watch.learnt_drives, watch.reference, watch.drives.size(), 1.0 / watch.alpha, watch.alpha));
  for (const std::string& note : watch.notes) page.item(note + ".");
  page.section("Evidence over the drives");
  add_picture(page, charts, "evidence",
              watch.alarm
                  ? "Evidence of a change over the drives with the limit of an alarm and the range of "
                    "the onset, and which drive is the first that differs"
                  : "Evidence of a change over the drives, with the limit of an alarm");
  write_drives(page, watch);
  if (watch.alarm) write_first_pointer(page, watch);
  if (watch.diagnosis) {
    page.section(
        fmt::format("The diagnosis of the drives from {} on", watch.drives[watch.diagnosed_since].id));
    write_diagnosis(page, *watch.diagnosed, *watch.diagnosis, charts);
  } else {
    page.paragraph(fmt::format("Slipway {}, campaign fingerprint {}", version(), watch.campaign_fingerprint));
  }
  return page;
}

}  // namespace slipway::api
