#include "api/report/gap_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "api/report/report_words.h"

namespace slipway::api {
namespace {

using gap::Diagnosis;
using gap::Verdict;
using Spans = std::vector<ReportText::Span>;
using Style = ReportText::Style;

void write_planners_view(ReportPage& page, const Diagnosis& d) {
  const gap::PlannersView& view = d.planners_view;
  if (view.observations == 0) return;
  page.paragraph(
      fmt::format("What planning with each model would have predicted of these drives: {} observations, "
                  "{} windows of which {} "
                  "slipped by more than {:g}, {} pairs of drives of which one clearly slipped more.",
                  view.observations, view.windows, view.immobilised, gap::kCensoredSlip, view.pairs));
  page.table(
      {"model", "within its 90 % interval", "immobilisation called", "called wrongly", "pairs in order"});
  for (const auto& [name, figures] : {std::pair{"nominal", &view.nominal},
                                      {"re-tuned", &view.retuned},
                                      {"with effects", &view.with_effects}})
    page.row({name, fmt::format("{:.0f} %", 100.0 * figures->within_90),
              fmt::format("{} of {}", figures->called, view.immobilised),
              fmt::format("{}", figures->false_calls),
              view.pairs > 0 ? fmt::format("{:.0f} %", 100.0 * figures->in_order) : std::string()});
}

void write_regimes(ReportPage& page, std::string_view title, const std::vector<gap::Regime>& regimes) {
  page.paragraph(title);
  if (regimes.empty()) return page.paragraph("No slice holds more than its share.");
  page.table({"slice", "channel", "where", "share of the gap", "share of the data", "p"});
  std::size_t number = 0;
  for (const gap::Regime& regime : regimes) {
    std::vector<std::string> conditions;
    for (const gap::Condition& c : regime.conditions)
      conditions.push_back(fmt::format("{} {:.3g} to {:.3g}", gap::name_of(c.variable), c.from, c.to));
    page.row({fmt::format("{}", ++number), std::string(gap::name_of(regime.channel)),
              fmt::format("{}", fmt::join(conditions, " and ")),
              fmt::format("{:.0f} %", 100.0 * regime.share_of_gap),
              fmt::format("{:.0f} %", 100.0 * regime.share_of_data), p_words(regime.significance)});
  }
}

void write_map(ReportPage& page, const Diagnosis& d, const std::vector<NamedChart>& charts) {
  add_picture(page, charts, "map",
              "The map of the gap: windows of drives held out of the fit, coloured by how far they are off");
  if (d.places.empty()) return;
  page.paragraph("Places on the map where the gap sits:");
  page.table({"terrain", "x, m", "y, m", "radius, m", "channel", "share of the gap"});
  for (const gap::GapPlace& p : d.places)
    page.row({p.terrain, fmt::format("{:.1f}", p.x_m), fmt::format("{:.1f}", p.y_m),
              fmt::format("{:.1f}", p.radius_m), std::string(gap::name_of(p.channel)),
              fmt::format("{:.0f} %", 100.0 * p.share_of_gap)});
}

// The rungs of a channel, each with its interval; `closed` and `described`: whether any channel has them.
std::vector<ReportText> ladder_cells(const gap::ChannelClosure& c, bool described, bool closed) {
  const double unit = gap::boundary_unit(c.channel);
  std::vector<ReportText> cells{gap::name_of(c.channel), gap::unit_of(c.channel),
                                interval_words(c.nominal, unit), interval_words(c.retuned, unit),
                                interval_words(c.with_effects, unit)};
  if (described)
    cells.emplace_back(c.with_discrepancy ? interval_words(*c.with_discrepancy, unit) : std::string());
  cells.emplace_back(interval_words(c.noise_floor, unit));
  if (closed) cells.emplace_back(c.closed_fraction ? interval_words(*c.closed_fraction) : std::string());
  return cells;
}

void write_ladder_table(ReportPage& page, const Diagnosis& d) {
  page.paragraph(
      "How far prediction and measurement are apart (root mean square) on drives that the fit had not seen, "
      "with 90 % intervals. Read each row from left to right, as a ladder:");
  page.item(d.reference ? "nominal: the model as the reference left it, with the difference that it taught"
                        : "nominal: the model as it was given");
  page.item(d.reference
                ? "re-tuned: soils and motors as the drives want them, within what the reference left "
                  "open. It may predict slightly worse than nominal where there is little to re-tune"
                : "re-tuned: soils and motors as the drives want them, within what was believed of "
                  "them");
  page.item("with effects: the named effects at work besides; as re-tuned where none is named");
  page.item(
      "with discrepancy: what nobody has named is described as well, as far as it repeats from drive to "
      "drive. Where this is much lower than the rung before it, something is still missing");
  page.item(
      "floor: what sensors and the drives' own scatter are estimated to leave. A rung below it says that the "
      "drives scattered by less than was estimated");
  const auto any = [&](const auto& member) {
    return std::any_of(d.gap.begin(), d.gap.end(),
                       [&](const gap::ChannelClosure& c) { return (c.*member).has_value(); });
  };
  const bool closed = any(&gap::ChannelClosure::closed_fraction);
  const bool described = any(&gap::ChannelClosure::with_discrepancy);
  std::vector<std::string> heads{"channel", "unit", "nominal", "re-tuned", "with effects"};
  if (described) heads.emplace_back("with discrepancy");
  heads.emplace_back("floor");
  if (closed) heads.emplace_back("closed");
  page.table(std::move(heads));
  for (const gap::ChannelClosure& c : d.gap) page.row(ladder_cells(c, described, closed));
  if (closed)
    page.paragraph(
        "Closed: of the way from re-tuned to the floor, the share that the effects go; 1 is all of it.");
}

}  // namespace

void write_reference(ReportPage& page, const Diagnosis& d) {
  if (!d.reference) return;
  const gap::ReferenceSummary& reference = *d.reference;
  page.section("What has changed since the reference");
  page.paragraph(fmt::format(
      "{} drives of {} ({} windows) were taken as healthy. They told of the soils and motors, and how the "
      "model differs from a rover on which nothing is wrong. The question here is therefore not whether the "
      "model is right, but what these drives show that those did not.",
      reference.drives, reference.campaign, reference.windows));
  if (reference.channels.empty()) return;
  page.paragraph(
      "Learnt: how far the model is off in drives like these although nothing is wrong; it is corrected for. "
      "Left open: what of it the reference could not tell; a change that is smaller and of the same shape is "
      "not noticed.");
  page.table({"channel", "unit", "learnt, rms", "left open, rms"});
  for (const gap::ReferenceSummary::LearntChannel& c : reference.channels) {
    const double unit = gap::boundary_unit(c.channel);
    page.row({gap::name_of(c.channel), gap::unit_of(c.channel), number_words("{:.3g}", unit * c.learnt),
              number_words("{:.3g}", unit * c.open)});
  }
}

void write_ladder(ReportPage& page, const Diagnosis& d, const std::vector<NamedChart>& charts) {
  if (d.gap.empty()) return;
  page.section("How far the gap closes");
  write_ladder_table(page, d);
  if (d.closed_fraction)
    page.paragraph(Spans{{"Of the gap that re-tuning leaves, closed: "},
                         {interval_words(*d.closed_fraction), Style::kStrong},
                         {", all channels in their deviations."}});
  write_planners_view(page, d);
  if (!d.extrapolations.empty()) {
    page.paragraph(
        "Learnt from the gentle drives and used to predict the harshest third: gain of log density a drive "
        "over re-tuned parameters alone.");
    page.table({"predicted", "drives", "gain", "standard error"});
    for (const gap::Extrapolation& e : d.extrapolations)
      page.row({fmt::format("{} {} {:.3g}", e.variable, e.above ? "above" : "below", e.limit),
                fmt::format("{}", e.groups), number_words("{:+.2f}", e.log_density_gain),
                number_words("{:.2f}", e.error)});
  }
  add_picture(page, charts, "ladder", "The same as a picture: each rung, by channel");
  add_picture(page, charts, "windows", "Predicted over measured, by channel");
}

void write_where(ReportPage& page, const Diagnosis& d, const std::vector<NamedChart>& charts) {
  page.section("Where");
  page.paragraph(
      "Before any re-tuning, measured less predicted; p corrected for the number of channels looked at.");
  page.table({"channel", "wheel", "unit", "gap, rms", "scatter", "mean", "p"});
  for (const gap::ChannelGap& c : d.channels) {
    const double unit = gap::boundary_unit(c.channel);
    page.row({std::string(gap::name_of(c.channel)), c.wheel.value_or("all"),
              std::string(gap::unit_of(c.channel)), number_words("{:.3g}", unit * c.gap),
              number_words("{:.3g}", unit * c.noise), number_words("{:+.3g}", unit * c.bias),
              p_words(c.significance)});
  }
  add_picture(page, charts, "channels", "The gap over its scatter, by channel and wheel");
  if (d.verdict == Verdict::kInsufficient) return;
  write_regimes(page, "Before re-tuning, the gap is larger than elsewhere in", d.regimes);
  write_regimes(page, "After re-tuning, in", d.regimes_retuned);
  if (!d.channels_of_effects.empty()) {
    std::vector<std::string> channels;
    for (const gap::ChannelShare& c : d.channels_of_effects)
      channels.push_back(fmt::format("{} {:.0f} %", gap::name_of(c.channel), 100.0 * c.share));
    page.paragraph(fmt::format("What the effects do, in squared deviations of the noise, is {}.",
                               fmt::join(channels, ", ")));
  }
  if (!d.effects.empty() && d.verdict != Verdict::kUnknown)
    write_regimes(page, "What the effects themselves do (only this tells where the cause is), in",
                  d.regimes_of_effect);
  add_picture(page, charts, "regimes",
              "Slices of the drives: what they hold of the gap beside what they hold of the data");
  write_map(page, d, charts);
}

void add_picture(ReportPage& page, const std::vector<NamedChart>& charts, std::string_view name,
                 std::string_view caption) {
  const auto chart =
      std::find_if(charts.begin(), charts.end(), [&](const NamedChart& c) { return c.name == name; });
  if (chart != charts.end()) page.picture(*chart, std::string(caption));
}

}  // namespace slipway::api
