#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "benchmark/drive_acquisition.h"

namespace slipway::gap {

// The least number of drives from which on two steps in a row are right, or at which the last step is;
// nothing where there is none.
std::optional<std::size_t> drives_needed(std::span<const AcquisitionStep> steps);

// A campaign with designed next drives and, several times, with random ones.
struct DrivesNeededCase {
  std::string campaign, hidden, kind, fidelity;
  std::size_t limit = 0;  // drives of the last step
  std::optional<std::size_t> designed;
  std::vector<std::optional<std::size_t>> random;  // one a repeat, not empty

  // Random's; nothing where half of the repeats or more did not find it.
  std::optional<double> random_median() const;
  // Designed over random's median, what was not found counting as the limit; nothing where neither found it,
  // or where the first drives were enough for both.
  std::optional<double> ratio(std::size_t first) const;
};

struct DrivesNeededSummary {
  std::size_t campaigns = 0, compared = 0;  // compared: that have a ratio
  std::size_t first_enough = 0;             // the first drives told it, whatever came then
  std::size_t designed_not_found = 0;
  std::size_t random_runs = 0, random_not_found = 0;
  std::optional<double> median_ratio;
  // 90 % interval of the median by order statistics; nothing of fewer than five.
  std::optional<double> ratio_low, ratio_high;
};
DrivesNeededSummary summary_of(std::span<const DrivesNeededCase> cases, std::size_t first);

// How many drives diagnoses needed, with designed next drives and with random ones.
struct DrivesNeeded {
  std::uint64_t seed = 1;  // of what was drawn
  std::size_t first = 0;   // drives that every run began with
  std::vector<DrivesNeededCase> cases;
};

}  // namespace slipway::gap
