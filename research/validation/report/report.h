#pragma once

#include <optional>
#include <string>
#include <vector>

namespace slipway::validation {

// One measured number and its prediction.
struct Case {
  std::string name;      // "smooth, slip 0.2"
  std::string quantity;  // "drawbar_pull"
  std::string unit;      // "N"; "1" for a number without a unit
  double measured = 0.0;
  std::optional<double> predicted;  // empty where there is no prediction of the data yet
};

// A figure and the range in which it is stated to be.
struct StatedBand {
  std::string what;  // with its unit: "rms of slip"
  double value = 0.0, lowest = 0.0, highest = 0.0;

  bool holds() const { return value >= lowest && value <= highest; }
};

// One comparison with something outside this project, as it stands in docs/validation.md.
struct Report {
  std::string title;
  std::string source;  // who measured or computed it
  std::string peers;   // results of others on the same figures; empty where none are known
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> notes;  // the interpretation, misses first
  std::vector<StatedBand> bands;
  std::vector<Case> cases;
  std::string plot;  // an SVG document; empty where a picture would show no more than the table

  bool holds() const;
  std::string markdown() const;
};

}  // namespace slipway::validation
