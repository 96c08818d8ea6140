#include "api/chart/chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>
#include <string>

#include "api/chart/chart_axes.h"

namespace slipway::api {
namespace {

Chart simple_chart() {
  return {.title = "pull",
          .x = {"slip", {}, {}, false, {}},
          .y = {"drawbar pull, N", {}, {}, false, {}},
          .bands = {{"published band", {0.0, 1.0}, {0.0, 5.0}, {2.0, 7.0}, 0}},
          .series = {{"measured", ChartMark::kPoints, {0.0, 0.5, 1.0}, {1.0, 4.0, 6.0}, 1},
                     {"predicted", ChartMark::kLine, {0.0, 0.5, 1.0}, {1.5, 3.5, 6.5}, 2}},
          .diagonal = false};
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

// Every opened element is closed, in order, and no bare < or & stands in between.
void expect_well_formed(const std::string& svg) {
  std::vector<std::string> open;
  const std::regex tag(R"(<(/?)([A-Za-z]+)((?:\s+[A-Za-z:-]+="[^"<]*")*)\s*(/?)>)");
  std::size_t covered = 0;
  for (auto it = std::sregex_iterator(svg.begin(), svg.end(), tag); it != std::sregex_iterator(); ++it) {
    if ((*it)[1].length() > 0) {
      ASSERT_FALSE(open.empty());
      EXPECT_EQ(open.back(), (*it)[2].str());
      open.pop_back();
    } else if ((*it)[4].length() == 0) {
      open.push_back((*it)[2].str());
    }
    ++covered;
  }
  EXPECT_TRUE(open.empty());
  EXPECT_EQ(covered, count(svg, "<"));
  EXPECT_EQ(count(svg, "nan") + count(svg, "inf\""), 0U);
}

TEST(NiceTicks, StepsAreOneTwoOrFiveTimesAPowerOfTenAndCoverTheRange) {
  for (const double span : {0.013, 0.07, 0.9, 1.0, 3.0, 17.0, 444.0, 2.2e6})
    for (const double low : {-span / 3.0, 0.0, 5.0 * span}) {
      const auto ticks = nice_ticks(low, low + span, 5);
      ASSERT_GE(ticks.size(), 3U);
      EXPECT_LE(ticks.size(), 8U);
      EXPECT_LE(ticks.front(), low + 1e-6 * span);
      EXPECT_GE(ticks.back(), low + span - 1e-6 * span);
      const double step = ticks[1] - ticks[0];
      const double digit = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
      EXPECT_TRUE(std::abs(digit - 1.0) < 1e-6 || std::abs(digit - 2.0) < 1e-6 ||
                  std::abs(digit - 5.0) < 1e-6)
          << step;
    }
  EXPECT_EQ(nice_ticks(0.0, 10.0, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_GE(nice_ticks(3.0, 3.0, 5).size(), 3U);  // one value is a range too
}

// Two neighbouring numbers are 16384 apart here: a double that counts the ticks, 2e16 and more, stays at its
// value when one is added to it.
TEST(NiceTicks, EndForNumbersTooLargeToBeCountedByOnes) {
  const auto ticks = nice_ticks(1e20, 1e20 + 16384.0, 5);
  EXPECT_LE(ticks.size(), 8U);
  EXPECT_EQ(ticks.front(), 1e20);
  EXPECT_EQ(ticks.back(), 1e20 + 16384.0);
}

TEST(TickWords, ShowAsManyDecimalsAsTheStepHas) {
  EXPECT_EQ(tick_words(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(tick_words(0.25, 0.05), "0.25");
  EXPECT_EQ(tick_words(-0.0, 0.1), "0.0");
  EXPECT_EQ(tick_words(40.0, 20.0), "40");
  EXPECT_EQ(tick_words(2e6, 5e5), "2e+06");
}

TEST(AxisScale, ALogarithmicAxisGivesEveryDecadeTheSameLengthAndLeavesOutWhatIsNotPositive) {
  const ChartAxis axis{"depth, m", {}, {}, true, {}};
  const AxisScale scale(axis, {0.001, 0.01, 1.0, -3.0, 0.0}, 0.0, 300.0);
  EXPECT_NEAR(scale.px(0.001), 0.0, 1e-9);
  EXPECT_NEAR(scale.px(0.01), 100.0, 1e-9);
  EXPECT_NEAR(scale.px(1.0), 300.0, 1e-9);
  EXPECT_FALSE(scale.shows(0.0));
  EXPECT_TRUE(scale.shows(1e-9));
}

TEST(Chart, IsAWellFormedDocumentWithAxesLegendAndTitle) {
  const Chart charts[] = {simple_chart(), simple_chart()};
  const std::string svg = draw_charts("Two of a kind", charts);
  expect_well_formed(svg);
  EXPECT_EQ(count(svg, "drawbar pull, N"), 2U);  // one y axis each
  EXPECT_EQ(count(svg, ">measured<"), 1U);       // one legend for both
  EXPECT_EQ(count(svg, ">predicted<"), 1U);
  EXPECT_EQ(count(svg, ">published band<"), 1U);
  EXPECT_EQ(count(svg, "<clipPath"), 2U);
  EXPECT_NE(svg.find(">Two of a kind<"), std::string::npos);
}

TEST(Chart, TheSameChartGivesTheSameBytes) {
  const Chart charts[] = {simple_chart()};
  EXPECT_EQ(draw_charts("t", charts), draw_charts("t", charts));
}

TEST(Chart, TextFromOutsideCanNotBecomeMarkup) {
  Chart chart = simple_chart();
  chart.series[0].name = "<script>alert(\"1\")</script> & 'so'";
  chart.x.title = "a < b";
  chart.x.categories = {"<i>", "b&c"};
  const std::string svg = draw_charts("</svg>", std::span(&chart, 1));
  expect_well_formed(svg);
  EXPECT_EQ(svg.find("<script"), std::string::npos);
  EXPECT_NE(svg.find("&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt; &amp; &#39;so&#39;"),
            std::string::npos);
}

TEST(Chart, AValueThatIsNotANumberPartsTheLineAndIsNotDrawn) {
  Chart chart = simple_chart();
  chart.bands.clear();
  chart.series = {{"", ChartMark::kLine, {0, 1, 2, 3, 4}, {1, 2, std::nan(""), 3, 4}, 0},
                  {"", ChartMark::kPoints, {0, 1, 2}, {1, std::numeric_limits<double>::infinity(), 3}, 0}};
  const std::string svg = draw_charts("t", std::span(&chart, 1));
  expect_well_formed(svg);
  EXPECT_EQ(count(svg, "<circle"), 2U);
  const std::smatch match = [&] {
    std::smatch m;
    EXPECT_TRUE(std::regex_search(svg, m, std::regex("<path d=\"(M[^\"]*)\" fill=\"none\"")));
    return m;
  }();
  EXPECT_EQ(count(match[1].str(), "M"), 2U);
}

TEST(Chart, NothingToShowIsStillADocument) {
  Chart chart = simple_chart();
  chart.series.clear();
  chart.bands.clear();
  expect_well_formed(draw_charts("empty", std::span(&chart, 1)));
  expect_well_formed(draw_charts("none", {}));
}

TEST(HeatMap, DrawsPointsAndLinesOverTheCellsWithALegend) {
  HeatMap map{.title = "score",
              .x = {"a", {}, {}, false, {}},
              .y = {"b", {}, {}, true, {}},
              .x_edges = {0, 1, 2},
              .y_edges = {1, 10, 100},
              .values = {1.0, 2.0, 3.0, 4.0},
              .value_title = "score"};
  const std::string bare = draw_heat_map(map);
  map.series = {{.name = "best", .mark = ChartMark::kPoints, .x = {1.0, 5.0}, .y = {10.0, 10.0}, .colour = 0},
                {.name = "95 %", .mark = ChartMark::kLine, .x = {0.5, 3.0}, .y = {2.0, 50.0}, .colour = 1}};
  const std::string svg = draw_heat_map(map);
  expect_well_formed(svg);
  EXPECT_EQ(count(svg, "<circle"), 2U);  // the point inside, and the legend's
  EXPECT_EQ(count(svg, ">best</text>"), 1U);
  EXPECT_EQ(count(svg, "clip-path=\"url(#cells)\""), 1U);
  EXPECT_EQ(count(bare, "clipPath"), 0U);
  EXPECT_EQ(count(svg, "crispEdges"), 4U);
}

TEST(HeatMap, DrawsOneCellPerValueFromTheLowestYAndMissingOnesGrey) {
  const HeatMap map{.title = "slip",
                    .x = {"pitch, deg", {}, {}, false, {}},
                    .y = {"roll, deg", {}, {}, false, {}},
                    .x_edges = {0, 10, 20, 30},
                    .y_edges = {0, 5, 10},
                    .values = {0.0, 0.5, 1.0, std::nullopt, 0.25, 0.75},
                    .value_title = "slip"};
  const std::string svg = draw_heat_map(map);
  expect_well_formed(svg);
  EXPECT_EQ(count(svg, "crispEdges"), 6U);
  EXPECT_EQ(count(svg, "fill=\"#bbb\""), 1U);
  EXPECT_EQ(count(svg, "fill=\"#440154\" shape"), 1U);  // the lowest value
  EXPECT_EQ(count(svg, "fill=\"#fde725\" shape"), 1U);  // the highest
  // The first row is the lower one: its cells begin further down.
  std::smatch m;
  ASSERT_TRUE(std::regex_search(svg, m, std::regex("y=\"([0-9.]+)\"[^>]*#440154")));
  const double lower = std::stod(m[1]);
  ASSERT_TRUE(std::regex_search(svg, m, std::regex("y=\"([0-9.]+)\"[^>]*#bbb")));
  EXPECT_GT(lower, std::stod(m[1]));
}

}  // namespace
}  // namespace slipway::api
