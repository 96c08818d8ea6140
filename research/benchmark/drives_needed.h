#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "research/benchmark/drive_acquisition.h"

namespace slipway::gap {

// The minimum number of drives from which on two steps in a row are right, or at which the last step is
// right; empty where there is none.
std::optional<std::size_t> drives_needed(std::span<const AcquisitionStep> steps);

// A campaign with designed next drives and, several times, with random ones.
struct DrivesNeededCase {
  std::string campaign, hidden, kind, fidelity;
  std::size_t limit = 0;  // drives of the last step
  std::optional<std::size_t> designed;
  std::vector<std::optional<std::size_t>> random;  // one for each repeat, at least one

  // The median of the random runs; empty where half of the repeats or more did not find the answer.
  std::optional<double> random_median() const;
  // The designed number over random's median, where a run that did not find the answer counts with the limit.
  // Empty where neither found it, or where the first drives were enough for both.
  std::optional<double> ratio(std::size_t first) const;
};

struct DrivesNeededSummary {
  std::size_t campaigns = 0, compared = 0;  // "compared" are those that have a ratio
  std::size_t first_enough = 0;             // campaigns that were right with the first drives
  std::size_t designed_not_found = 0;
  std::size_t random_runs = 0, random_not_found = 0;
  std::optional<double> median_ratio;
  // 90 % interval of the median by order statistics; empty for fewer than five campaigns.
  std::optional<double> ratio_low, ratio_high;
};
DrivesNeededSummary summary_of(std::span<const DrivesNeededCase> cases, std::size_t first);

// How many drives diagnoses needed, with designed next drives and with random ones.
struct DrivesNeeded {
  std::uint64_t seed = 1;  // of the random draws
  std::size_t first = 0;   // number of drives with which every run began
  std::vector<DrivesNeededCase> cases;
};

}  // namespace slipway::gap
