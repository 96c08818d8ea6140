#include "api/report/diagnosis_charts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "api/documents/diagnosis/diagnosis_document.h"
#include "api/report/gap_map.h"

namespace slipway::api {
namespace {

using gap::Channel;
using gap::Diagnosis;
using gap::Interval;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kHalfBar = 0.3;  // of the width between two categories
constexpr std::size_t kMaxExplanations = 5;

std::string words_of(Channel channel) {
  std::string words(gap::name_of(channel));
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string with_unit(Channel channel) {
  const std::string_view unit = gap::row_of(channel).chart_unit;
  return unit == "1" ? words_of(channel) : fmt::format("{}, {}", words_of(channel), unit);
}

ChartSeries series_of(std::string name, ChartMark mark, std::size_t colour) {
  return {.name = std::move(name), .mark = mark, .x = {}, .y = {}, .colour = colour};
}

void add_bar(Chart& chart, std::string name, double at, double low, double high, std::size_t colour) {
  chart.bands.push_back({.name = std::move(name),
                         .x = {at - kHalfBar, at + kHalfBar},
                         .lower = {low, low},
                         .upper = {high, high},
                         .colour = colour});
}

void add_level(ChartSeries& line, double at, double value) {
  for (const double x : {at - kHalfBar, at + kHalfBar, kNothing}) {
    line.x.push_back(x);
    line.y.push_back(value);
  }
}

// Names are long: they stand in the legend.
std::string draw_explanations(const Diagnosis& d) {
  Chart chart;
  chart.x.title = "rank";
  chart.y.title = "probability";
  chart.y.lowest = 0.0;
  chart.y.highest = 1.0;
  std::size_t rank = 0;
  for (const gap::ComparedSet& set : json::compared_sets(d)) {
    ++rank;
    const bool ends = set.effects.empty();  // nothing missing, or something unknown alone
    if (rank > kMaxExplanations && !ends) continue;
    const std::size_t index = chart.x.categories.size();
    const auto at = static_cast<double>(index);
    const std::vector<std::string> names = gap::names_of(set);
    const std::string name = names.empty() ? "nothing missing" : fmt::format("{}", fmt::join(names, " + "));
    chart.x.categories.push_back(fmt::format("{}", rank));
    add_bar(chart, fmt::format("{}: {}", rank, name), at, 0.0, set.probability, index);
    ChartSeries top = series_of("", ChartMark::kLine, index);
    add_level(top, at, set.probability);
    chart.series.push_back(std::move(top));
  }
  return draw_charts(fmt::format("{}: explanations compared", d.campaign), std::span(&chart, 1));
}

// One panel for the rover's channels, one for each channel of wheels.
std::string draw_channels(const Diagnosis& d) {
  std::vector<Chart> charts;
  std::vector<std::string> titles;
  for (const gap::ChannelGap& channel : d.channels) {
    if (!(channel.noise > 0.0) || !std::isfinite(channel.gap)) continue;
    const std::string title = channel.wheel ? words_of(channel.channel) + " of each wheel" : "the rover";
    auto place = std::find(titles.begin(), titles.end(), title);
    if (place == titles.end()) {
      titles.push_back(title);
      Chart& chart = charts.emplace_back();
      chart.title = title;
      chart.y.title = "rms over what scatter makes it";
      chart.y.lowest = 0.0;
      chart.series = {series_of("gap, significant", ChartMark::kPoints, 1),
                      series_of("gap, not significant", ChartMark::kPoints, 0),
                      series_of("mean", ChartMark::kPoints, 3),
                      series_of("as the scatter", ChartMark::kDashedLine, 6)};
      place = titles.end() - 1;
    }
    Chart& chart = charts[static_cast<std::size_t>(place - titles.begin())];
    const auto at = static_cast<double>(chart.x.categories.size());
    chart.x.categories.push_back(channel.wheel ? *channel.wheel : words_of(channel.channel));
    ChartSeries& gaps = chart.series[channel.significance < 0.05 ? 0 : 1];
    gaps.x.push_back(at);
    gaps.y.push_back(channel.gap / channel.noise);
    chart.series[2].x.push_back(at);
    chart.series[2].y.push_back(std::abs(channel.bias) / channel.noise);
  }
  for (Chart& chart : charts) {
    chart.series[3].x = {-0.5, static_cast<double>(chart.x.categories.size()) - 0.5};
    chart.series[3].y = {1.0, 1.0};
  }
  if (charts.empty()) return {};
  return draw_charts(fmt::format("{}: the gap before any re-tuning", d.campaign), charts);
}

std::string draw_ladder(const Diagnosis& d) {
  std::vector<Chart> charts;
  for (const gap::ChannelClosure& channel : d.gap) {
    const double unit = gap::row_of(channel.channel).chart_scale;
    Chart& chart = charts.emplace_back();
    chart.title = words_of(channel.channel);
    chart.y.title = with_unit(channel.channel) + ", rms";
    chart.y.lowest = 0.0;
    chart.x.categories = {"nominal", "re-tuned", "with effects"};
    std::vector<Interval> levels{channel.nominal, channel.retuned, channel.with_effects};
    if (channel.with_discrepancy) {
      chart.x.categories.emplace_back("with discrepancy");
      levels.push_back(*channel.with_discrepancy);
    }
    chart.x.categories.emplace_back("floor");
    levels.push_back(channel.noise_floor);
    ChartSeries values = series_of("held-out drives", ChartMark::kLine, 1);
    for (std::size_t k = 0; k < levels.size(); ++k) {
      const auto at = static_cast<double>(k);
      if (!std::isfinite(levels[k].value)) continue;
      if (std::isfinite(levels[k].low) && std::isfinite(levels[k].high))
        add_bar(chart, "90 % interval", at, unit * levels[k].low, unit * levels[k].high, 0);
      add_level(values, at, unit * levels[k].value);
    }
    chart.series = {std::move(values)};
  }
  if (charts.empty()) return {};
  return draw_charts(fmt::format("{}: how far the gap closes", d.campaign), charts);
}

std::string draw_windows(const Diagnosis& d) {
  const bool effects = !d.effects.empty();
  std::vector<Chart> charts;
  for (std::size_t c = 0; c < gap::channel_count(); ++c) {
    const auto channel = static_cast<Channel>(c);
    const double unit = gap::row_of(channel).chart_scale;
    ChartSeries nominal = series_of("nominal", ChartMark::kDots, 6),
                retuned = series_of("re-tuned", ChartMark::kDots, 4),
                with = series_of("with effects", ChartMark::kDots, 0);
    for (const gap::HeldOutPoint& p : d.held_out) {
      if (p.channel != channel) continue;
      for (const auto& [series, value] :
           {std::pair{&nominal, p.nominal}, {&retuned, p.retuned}, {&with, p.with_effects}}) {
        series->x.push_back(unit * p.measured);
        series->y.push_back(unit * value);
      }
    }
    if (nominal.x.empty()) continue;
    Chart& chart = charts.emplace_back();
    chart.title = words_of(channel);
    chart.x.title = with_unit(channel) + ", measured";
    chart.y.title = "predicted";
    chart.diagonal = true;
    chart.series = {std::move(nominal), std::move(retuned)};
    if (effects) chart.series.push_back(std::move(with));
  }
  if (charts.empty()) return {};
  return draw_charts(fmt::format("{}: windows of drives held out of the fit", d.campaign), charts);
}

std::string draw_parameters(const Diagnosis& d) {
  Chart chart;
  chart.y.title = "in deviations of the prior";
  ChartSeries determined = series_of("the drives tell", ChartMark::kPoints, 1),
              undetermined = series_of("as believed before", ChartMark::kPoints, 0);
  for (const gap::RetunedParameter& p : d.retuned) {
    if (!(p.prior_std > 0.0) || !std::isfinite(p.value.value)) continue;
    const auto at = static_cast<double>(chart.x.categories.size());
    chart.x.categories.push_back(p.name);
    add_bar(chart, "90 % interval", at, p.value.low / p.prior_std, p.value.high / p.prior_std, 0);
    ChartSeries& series = p.determined ? determined : undetermined;
    series.x.push_back(at);
    series.y.push_back(p.value.value / p.prior_std);
  }
  if (chart.x.categories.empty()) return {};
  chart.series = {std::move(determined), std::move(undetermined)};
  return draw_charts(fmt::format("{}: parameters re-tuned", d.campaign), std::span(&chart, 1));
}

// Slices numbered as in the report's tables, one panel a stage.
std::string draw_regimes(const Diagnosis& d) {
  std::vector<Chart> charts;
  for (const auto& [title, regimes] : {std::pair{"before re-tuning", &d.regimes},
                                       {"after re-tuning", &d.regimes_retuned},
                                       {"what the effects do", &d.regimes_of_effect}}) {
    if (regimes->empty()) continue;
    Chart& chart = charts.emplace_back();
    chart.title = title;
    chart.x.title = "slice";
    chart.y.title = "share, %";
    chart.y.lowest = 0.0;
    chart.y.highest = 100.0;
    ChartSeries of_gap = series_of("of the gap", ChartMark::kLine, 1),
                of_data = series_of("of the data", ChartMark::kLine, 0);
    for (const gap::Regime& regime : *regimes) {
      const auto at = static_cast<double>(chart.x.categories.size());
      chart.x.categories.push_back(fmt::format("{}: {}", at + 1.0, words_of(regime.channel)));
      add_bar(chart, "", at, 0.0, 100.0 * regime.share_of_gap, 1);
      add_level(of_gap, at, 100.0 * regime.share_of_gap);
      add_level(of_data, at, 100.0 * regime.share_of_data);
    }
    chart.series = {std::move(of_gap), std::move(of_data)};
  }
  if (charts.empty()) return {};
  return draw_charts(fmt::format("{}: slices that hold more than their share", d.campaign), charts);
}

}  // namespace

std::vector<NamedChart> draw_diagnosis(const gap::DriveCampaign& campaign, const Diagnosis& d) {
  std::vector<NamedChart> charts{{"explanations", draw_explanations(d)},
                                 {"channels", draw_channels(d)},
                                 {"ladder", draw_ladder(d)},
                                 {"windows", draw_windows(d)},
                                 {"parameters", draw_parameters(d)},
                                 {"regimes", draw_regimes(d)},
                                 {"map", draw_gap_map(campaign, d)}};
  std::erase_if(charts, [](const NamedChart& chart) { return chart.svg.empty(); });
  return charts;
}

}  // namespace slipway::api
