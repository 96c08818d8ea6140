#include "planner/search/slip_table_cache.h"

#include <algorithm>
#include <cstring>

namespace slipway::planner {

bool SlipTableKey::operator==(const SlipTableKey& other) const {
  return std::memcmp(&soil, &other.soil, sizeof(soil)) == 0 && gravity_m_s2 == other.gravity_m_s2 &&
         limit_rad == other.limit_rad && step_rad == other.step_rad &&
         conditions.motor_temp_c == other.conditions.motor_temp_c && rover == other.rover;
}

sim::SlipTable SlipTableCache::get(const SlipTableKey& key) {
  std::shared_ptr<const sim::SlipTable> table;
  {
    const std::scoped_lock lock(mutex_);
    const auto found =
        std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) { return kept.key == key; });
    if (found != kept_.end()) table = found->table;
  }
  if (table) return *table;
  table = std::make_shared<const sim::SlipTable>(key.make());
  const std::scoped_lock lock(mutex_);
  kept_.push_back({key, table});
  if (kept_.size() > kMost) kept_.pop_front();
  return *table;
}

}  // namespace slipway::planner
