#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>

#include "sim/quasi_static/slip_table.h"

namespace slipway::planner {

// All that a slip table depends on.
struct SlipTableKey {
  sim::RoverModel rover;
  double gravity_m_s2 = 0.0;
  sim::Soil soil;
  double limit_rad = 0.0, step_rad = 0.0;
  sim::DriveConditions conditions;

  // Soils byte by byte: what has the same bytes is the same, and of one that is told apart though it is the
  // same a table is made anew.
  bool operator==(const SlipTableKey& other) const;

  sim::SlipTable make() const { return {rover, gravity_m_s2, soil, limit_rad, step_rad, conditions}; }
};

// Keeps the tables that were asked for last: those who drag a goal ask for the same ground again and again,
// and its tables are a good part of such a plan. A table is what its key makes, so no answer depends on what
// is kept. Thread-safe.
class SlipTableCache {
 public:
  sim::SlipTable get(const SlipTableKey& key);

 private:
  struct Kept {
    SlipTableKey key;
    std::shared_ptr<const sim::SlipTable> table;
  };
  // Of a hundred kilobytes each; a map with five soils has some hundred.
  static constexpr std::size_t kMost = 256;

  std::mutex mutex_;
  std::deque<Kept> kept_;  // the oldest first
};

}  // namespace slipway::planner
