#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>

#include "core/result.h"

namespace slipway::server {

// What was drawn of answers, which never change: the last that were asked for, up to so many bytes by
// Drawn::size(). As many are drawn at once as threads ask, or one by one where each takes much memory.
// Thread-safe.
template <class Drawn>
class DrawnCache {
 public:
  explicit DrawnCache(std::size_t max_bytes, bool one_by_one = false)
      : max_bytes_(max_bytes), one_by_one_(one_by_one) {}

  using Kept = std::shared_ptr<const Drawn>;
  // What is kept under this key, or what `draw` makes now; an error is not kept.
  Result<Kept> get(const std::string& key, const std::function<Result<Drawn>()>& draw) {
    if (auto kept = find(key)) return kept;
    std::unique_lock drawing(drawing_mutex_, std::defer_lock);
    if (one_by_one_) drawing.lock();
    if (auto kept = one_by_one_ ? find(key) : nullptr) return kept;
    auto made = draw();
    if (!made) return fail(std::move(made.error()));
    const auto drawn = std::make_shared<const Drawn>(*std::move(made));
    keep(key, drawn);
    return drawn;
  }

 private:
  using Entries = std::list<std::pair<std::string, Kept>>;

  Kept find(const std::string& key) {
    const std::scoped_lock lock(mutex_);
    const auto found = places_.find(key);
    if (found == places_.end()) return nullptr;
    entries_.splice(entries_.begin(), entries_, found->second);
    return entries_.front().second;
  }

  void keep(const std::string& key, const Kept& drawn) {
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

  const std::size_t max_bytes_;
  const bool one_by_one_;
  std::mutex drawing_mutex_, mutex_;
  Entries entries_;  // the last asked for first
  std::unordered_map<std::string, typename Entries::iterator> places_;
  std::size_t bytes_ = 0;
};

}  // namespace slipway::server
