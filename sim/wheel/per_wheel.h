#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

namespace slipway::sim {

// The most wheels a rover may have: what the solvers set room aside for.
constexpr int kMaxWheels = 12;

// One value for each wheel of a rover, in the order of its wheels: as many as the rover has, kept in place so
// that nothing is allocated in a solver's loop.
template <class T>
class PerWheel {
 public:
  PerWheel() = default;
  // T's own initial value for each.
  explicit PerWheel(std::size_t count) : count_(count) { assert(count <= values_.size()); }
  PerWheel(std::size_t count, const T& value) : PerWheel(count) { std::fill(begin(), end(), value); }

  PerWheel(const PerWheel& other) : PerWheel() { *this = other; }
  // The places that the rover has no wheel for stay as they are.
  PerWheel& operator=(const PerWheel& other) {
    if (this == &other) return *this;
    count_ = other.count_;
    std::copy(other.begin(), other.end(), begin());
    return *this;
  }
  ~PerWheel() = default;

  std::size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  T& operator[](std::size_t k) {
    assert(k < count_);
    return values_[k];
  }
  const T& operator[](std::size_t k) const {
    assert(k < count_);
    return values_[k];
  }
  T* begin() { return values_.data(); }
  T* end() { return values_.data() + count_; }
  const T* begin() const { return values_.data(); }
  const T* end() const { return values_.data() + count_; }

 private:
  std::array<T, kMaxWheels> values_{};
  std::size_t count_ = 0;
};

}  // namespace slipway::sim
