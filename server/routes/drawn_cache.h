#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "core/result.h"

namespace slipway::server {

// What was drawn of answers, which never change: the last that were asked for, up to so many bytes.
// Thread-safe.
class DrawnCache {
 public:
  explicit DrawnCache(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  using Drawn = std::shared_ptr<const std::string>;
  // What is kept under this key, or what `draw` makes now; an error is not kept.
  Result<Drawn> get(const std::string& key, const std::function<Result<std::string>()>& draw);

 private:
  using Entries = std::list<std::pair<std::string, Drawn>>;

  void keep(const std::string& key, const Drawn& drawn);

  const std::size_t max_bytes_;
  std::mutex mutex_;
  Entries entries_;  // the last asked for first
  std::unordered_map<std::string, Entries::iterator> places_;
  std::size_t bytes_ = 0;
};

}  // namespace slipway::server
