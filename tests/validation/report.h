#pragma once

#include <string>
#include <vector>

namespace slipway::validation {

// One comparison with something outside this project, as it stands in docs/validation.md.
struct Report {
  std::string title;
  std::string source;  // who measured or computed it
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> notes;  // what to make of it, misses first
  bool holds = true;               // false breaks the build: a stated band is left

  std::string markdown() const;
};

// The median of absolute values; 0 of nothing.
double median_abs(std::vector<double> values);

Report kernel_cross_check();
Report ding_2011();
Report zhurong_states();
Report independent_simulator(const std::string& csv_path);
Report curiosity_attitude(const std::string& data_folder);
Report rungs();

}  // namespace slipway::validation
