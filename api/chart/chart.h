#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace slipway::api {

struct ChartAxis {
  std::string title;                      // with its unit: "drawbar pull, N"
  std::optional<double> lowest, highest;  // where absent, as the data need
  bool logarithmic = false;               // values that are not positive are then left out
  std::vector<std::string> categories;    // of an x axis: value k stands over the k-th of these names
};

enum class ChartMark {
  kLine,
  kDashedLine,
  kPoints,
  kDots,  // small ones, for hundreds of values
  kLineAndPoints,
};

// What is measured and what is predicted of one thing best have the same colour and different marks.
struct ChartSeries {
  std::string name;  // in the legend; empty: not there
  ChartMark mark = ChartMark::kLine;
  std::vector<double> x, y;  // of one length; a value that is not finite is left out and parts the line
  std::size_t colour = 0;    // index into a palette for colour-blind eyes
};

// The space between two lines, filled.
struct ChartBand {
  std::string name;
  std::vector<double> x, lower, upper;
  std::size_t colour = 0;
};

struct Chart {
  std::string title;
  ChartAxis x, y;
  std::vector<ChartBand> bands;
  std::vector<ChartSeries> series;
  bool diagonal = false;  // draws y = x: predicted against measured
};

// Charts beside each other under one title with one legend, as an SVG document. The same charts give the same
// bytes.
std::string draw_charts(std::string_view title, std::span<const Chart> charts);

// Values over two axes as coloured cells with a colour bar.
struct HeatMap {
  std::string title;
  ChartAxis x, y;
  std::vector<double> x_edges, y_edges;       // of the cells, rising; one more than there are cells
  std::vector<std::optional<double>> values;  // row by row from the lowest y; missing cells are grey
  std::string value_title;                    // with its unit
  std::vector<ChartSeries> series = {};       // drawn over the cells, with a legend
};

std::string draw_heat_map(const HeatMap& map);

struct NamedChart {
  std::string name;  // of a file, without its ending
  std::string svg;
};

// Round numbers a step of 1, 2 or 5 times a power of ten apart, from the last at or below `lowest` to the
// first at or above `highest`: at most about `wanted` + 2 of them. lowest <= highest, wanted >= 1.
std::vector<double> nice_ticks(double lowest, double highest, int wanted);

// &, <, > and quotes as entities, control characters as spaces: text that may stand in an XML document.
std::string xml_text(std::string_view text);

}  // namespace slipway::api
