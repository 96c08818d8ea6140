#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace slipway::api {

struct ChartAxis {
  std::string title;                      // with its unit: "drawbar pull, N"
  std::optional<double> lowest, highest;  // the ends; where absent, they follow from the data
  bool logarithmic = false;               // values that are not positive are then left out
  std::vector<std::string> categories;    // names along an x axis; the value k is above the k-th of them
};

enum class ChartMark {
  kLine,
  kDashedLine,
  kPoints,
  kDots,  // small points for hundreds of values
  kLineAndPoints,
};

// Measured and predicted values of one quantity should have the same colour and different marks.
struct ChartSeries {
  std::string name;  // in the legend; an empty name is not in it
  ChartMark mark = ChartMark::kLine;
  std::vector<double> x, y;  // of the same length; a value that is not finite is left out and breaks the line
  std::size_t colour = 0;    // index into a palette that colour-blind people can distinguish
};

// A filled area between two lines.
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
  bool diagonal = false;  // draws y = x, for predicted against measured values
};

// Draws charts beside each other under one title with one legend, as an SVG document. The same charts give
// the same bytes.
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
  std::string name;  // of its file, without the ending
  std::string svg;
};

// Round numbers whose distance is 1, 2 or 5 times a power of ten, from the last one at or below `lowest` to
// the first one at or above `highest`; at most about `wanted` + 2 of them. It needs lowest <= highest and
// wanted >= 1.
std::vector<double> nice_ticks(double lowest, double highest, int wanted);

// The text for an XML document: &, <, > and quotes become entities, control characters become spaces.
std::string xml_text(std::string_view text);

// The element of a picture's text, whose words may be anybody's.
std::string svg_text(std::string_view attributes, std::string_view words);

}  // namespace slipway::api
