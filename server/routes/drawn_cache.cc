#include "server/routes/drawn_cache.h"

namespace slipway::server {

Result<DrawnCache::Drawn> DrawnCache::get(const std::string& key,
                                          const std::function<Result<std::string>()>& draw) {
  {
    const std::scoped_lock lock(mutex_);
    if (const auto found = places_.find(key); found != places_.end()) {
      entries_.splice(entries_.begin(), entries_, found->second);
      return entries_.front().second;
    }
  }
  auto made = draw();
  if (!made) return fail(std::move(made.error()));
  const auto drawn = std::make_shared<const std::string>(*std::move(made));
  keep(key, drawn);
  return drawn;
}

void DrawnCache::keep(const std::string& key, const Drawn& drawn) {
  const std::scoped_lock lock(mutex_);
  if (drawn->size() > max_bytes_ || places_.contains(key)) return;
  entries_.emplace_front(key, drawn);
  places_[key] = entries_.begin();
  bytes_ += drawn->size();
  while (bytes_ > max_bytes_) {
    bytes_ -= entries_.back().second->size();
    places_.erase(entries_.back().first);
    entries_.pop_back();
  }
}

}  // namespace slipway::server
