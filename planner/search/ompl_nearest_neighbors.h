#pragma once

#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/datastructures/NearestNeighbors.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

namespace slipway::planner {

// Nearest neighbours in square buckets of the map. OMPL's own structure picks its pivots with the
// process-wide random numbers, so that its order of equals, and with it a tree, would depend on what ran
// before. Asks only that the distance is never less than the one between the places, as MotionSpace's is.
template <class T>
class BucketNearestNeighbors final : public ompl::NearestNeighbors<T> {
 public:
  // Buckets as wide as the ground's cells, where these are large: on cells of 463 m a search looked at more
  // than ten thousand empty buckets of 5 m for every neighbour.
  explicit BucketNearestNeighbors(double cell_m) : bucket_m_(std::max(kLeastBucket_m, cell_m)) {}

  bool reportsSortedResults() const override { return true; }
  void clear() override {
    buckets_.clear();
    all_.clear();
  }
  void add(const T& item) override {
    buckets_[key(column(item), row(item))].push_back(item);
    all_.push_back(item);
    low_column_ = std::min(low_column_, column(item));
    high_column_ = std::max(high_column_, column(item));
    low_row_ = std::min(low_row_, row(item));
    high_row_ = std::max(high_row_, row(item));
  }
  void add(const std::vector<T>& items) override {
    for (const T& item : items) add(item);
  }
  bool remove(const T& item) override {
    std::vector<T>& bucket = buckets_[key(column(item), row(item))];
    const auto in_bucket = std::find(bucket.begin(), bucket.end(), item);
    if (in_bucket == bucket.end()) return false;
    bucket.erase(in_bucket);
    all_.erase(std::find(all_.begin(), all_.end(), item));
    return true;
  }
  T nearest(const T& item) const override {
    std::vector<T> one;
    nearestK(item, 1, one);
    return one.front();
  }
  void nearestK(const T& item, std::size_t k, std::vector<T>& found) const override {
    gather(item, std::min(k, all_.size()), std::numeric_limits<double>::infinity(), found);
  }
  void nearestR(const T& item, double radius, std::vector<T>& found) const override {
    gather(item, all_.size(), radius, found);
  }
  std::size_t size() const override { return all_.size(); }
  void list(std::vector<T>& items) const override { items = all_; }

 private:
  static constexpr double kLeastBucket_m = 5.0;
  struct Near {
    double away;
    std::size_t order;  // in which it was met: by rings, and in them by adding
    T item;
    bool operator<(const Near& other) const {
      return away != other.away ? away < other.away : order < other.order;
    }
  };

  int column(const T& item) const { return index(state_of(item)->template as<State>()->getX()); }
  int row(const T& item) const { return index(state_of(item)->template as<State>()->getY()); }
  static const ompl::base::State* state_of(const T& item) { return item->state; }
  int index(double metres) const { return static_cast<int>(std::floor(metres / bucket_m_)); }
  static std::uint64_t key(int column, int row) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(column)) << 32 |
           static_cast<std::uint32_t>(row);
  }
  using State = ompl::base::SE2StateSpace::StateType;

  // Ring by ring around the item, until what lies further out cannot be among the k nearest.
  void gather(const T& item, std::size_t k, double radius, std::vector<T>& found) const {
    std::vector<Near> near;
    const int c = column(item);
    const int r = row(item);
    const int rings = std::max({c - low_column_, high_column_ - c, r - low_row_, high_row_ - r, 0});
    for (int ring = 0; ring <= rings; ++ring) {
      const double closest = (ring - 1) * bucket_m_;
      if (closest > radius || (near.size() >= k && k_th(near, k) <= closest)) break;
      for (int dc = -ring; dc <= ring; ++dc) {
        const int stride = std::abs(dc) == ring ? 1 : std::max(1, 2 * ring);
        for (int dr = -ring; dr <= ring; dr += stride) take(item, c + dc, r + dr, radius, near);
      }
    }
    const auto last = near.begin() + static_cast<std::ptrdiff_t>(std::min(k, near.size()));
    std::partial_sort(near.begin(), last, near.end());
    found.clear();
    for (auto one = near.begin(); one != last; ++one) found.push_back(one->item);
  }
  void take(const T& item, int c, int r, double radius, std::vector<Near>& near) const {
    const auto bucket = buckets_.find(key(c, r));
    if (bucket == buckets_.end()) return;
    for (const T& other : bucket->second) {
      const double away = this->distFun_(other, item);
      if (away <= radius) near.push_back({away, near.size(), other});
    }
  }
  static double k_th(const std::vector<Near>& near, std::size_t k) {
    std::vector<double> away;
    away.reserve(near.size());
    for (const Near& one : near) away.push_back(one.away);
    if (k == 0) return 0.0;
    std::nth_element(away.begin(), away.begin() + static_cast<std::ptrdiff_t>(k - 1), away.end());
    return away[k - 1];
  }

  double bucket_m_;
  std::unordered_map<std::uint64_t, std::vector<T>> buckets_;
  std::vector<T> all_;
  int low_column_ = std::numeric_limits<int>::max() / 2, high_column_ = std::numeric_limits<int>::min() / 2;
  int low_row_ = std::numeric_limits<int>::max() / 2, high_row_ = std::numeric_limits<int>::min() / 2;
};

}  // namespace slipway::planner
