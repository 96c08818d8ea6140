#include "gap/diagnosis/describe/regimes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>

#include "core/random.h"

namespace slipway::gap {
namespace {

constexpr double kSignificant = 0.1;
constexpr double kWorthASlice = 0.1;   // of a trace
constexpr double kPlainlyOff = 100.0;  // of a window's square

struct Scored {
  Regime regime;
  double rank = 0.0;
  const Slice* slice = nullptr;
};

std::vector<double> in_order(std::span<const double> values, std::span<const std::size_t> order) {
  std::vector<double> permuted;
  permuted.reserve(order.size());
  for (const std::size_t w : order) permuted.push_back(values[w]);
  return permuted;
}

// Beyond ten deviations none above the largest that more windows have than a slice needs: what fewer do is no
// slice, and one that a model calls stuck, a hundred deviations off, would outweigh all others.
std::vector<double> limited(std::span<const double> squares) {
  std::vector<double> all(squares.begin(), squares.end());
  const std::size_t least = least_of_slice(all.size());
  if (all.size() <= least) return all;
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(least), all.end(),
                   std::greater<double>());
  const double most = std::max(all[least], kPlainlyOff);
  std::transform(squares.begin(), squares.end(), all.begin(), [most](double s) { return std::min(s, most); });
  return all;
}

double sum_in(std::span<const double> values, const Slice& slice) {
  double sum = 0.0;
  for (const std::size_t w : slice.windows) sum += values[w];
  return sum;
}

// Intersection over union of a slice with the windows that are marked by 1, `marked` of them.
double overlap(std::span<const double> marks, double marked, const Slice& slice) {
  const double both = sum_in(marks, slice);
  return both / (marked + static_cast<double>(slice.windows.size()) - both);
}

// Much the same windows in the same channel are said once.
bool much_the_same(const Scored& a, const Scored& b) {
  if (a.regime.channel != b.regime.channel) return false;
  std::vector<std::size_t> shared;
  std::set_intersection(a.slice->windows.begin(), a.slice->windows.end(), b.slice->windows.begin(),
                        b.slice->windows.end(), std::back_inserter(shared));
  return 2 * shared.size() > std::min(a.slice->windows.size(), b.slice->windows.size());
}

}  // namespace

Excess::Excess(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  mean_ = std::accumulate(values.begin(), values.end(), 0.0) / n;
  for (const double v : values) variance_ += (v - mean_) * (v - mean_) / n;
}

double Excess::operator()(std::span<const double> values, const Slice& slice) const {
  const auto n = static_cast<double>(slice.windows.size()), all = static_cast<double>(values.size());
  // Drawn from so few without putting back: without the last factor wide slices would never stand out.
  const double variance = variance_ / n * (all - n) / (all - 1.0);
  return variance <= 0.0 ? 0.0 : (sum_in(values, slice) / n - mean_) / std::sqrt(variance);
}

std::vector<std::size_t> reordered(std::span<const std::size_t> drive_of, std::uint64_t key) {
  std::vector<std::vector<std::size_t>> drives;
  for (std::size_t w = 0; w < drive_of.size(); ++w) {
    if (w == 0 || drive_of[w] != drive_of[w - 1]) drives.emplace_back();
    drives.back().push_back(w);
  }
  for (std::size_t d = drives.size(); d > 1; --d)
    std::swap(drives[d - 1],
              drives[static_cast<std::size_t>(random_uniform(key, d) * static_cast<double>(d))]);
  std::vector<std::size_t> order;
  for (const auto& drive : drives) order.insert(order.end(), drive.begin(), drive.end());
  std::rotate(
      order.begin(),
      order.begin() + static_cast<std::ptrdiff_t>(random_uniform(key, 0) * static_cast<double>(order.size())),
      order.end());
  return order;
}

std::vector<ChannelShare> shares_of(std::span<const ChannelSquares> channels) {
  std::vector<ChannelShare> shares;
  double total = 0.0;
  for (const ChannelSquares& of : channels) {
    const std::vector<double> weights = limited(of.squares);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (sum > 0.0) shares.push_back({of.channel, sum});
    total += sum;
  }
  for (ChannelShare& share : shares) share.share /= total;
  std::stable_sort(shares.begin(), shares.end(),
                   [](const ChannelShare& a, const ChannelShare& b) { return a.share > b.share; });
  return shares;
}

std::vector<Regime> regimes_in(std::span<const Slice> slices, std::span<const ChannelSquares> channels,
                               std::span<const std::size_t> drive_of, LookedAt looked_at,
                               const DiagnosisOptions& options, std::size_t most,
                               const std::function<bool()>& cancelled) {
  std::vector<std::vector<std::size_t>> orders(static_cast<std::size_t>(options.resamples) / 4 + 1);
  for (std::size_t b = 0; b < orders.size(); ++b)
    orders[b] = reordered(drive_of, random_key(options.seed, 5000 + b));
  const bool trace = looked_at == LookedAt::kTrace;
  const std::vector<ChannelShare> shares = shares_of(channels);
  std::vector<Scored> scored;
  for (const ChannelSquares& of : channels) {
    const std::vector<double> weights = trace ? limited(of.squares) : of.squares;
    const Excess excess(weights);
    double share = 0.0;
    for (const ChannelShare& s : shares)
      if (s.channel == of.channel) share = s.share;
    const bool small = excess.mean() < 1.0 && (!trace || share < kWorthASlice);
    if (excess.variance() <= 0.0 || small) continue;
    std::vector<double> marks;
    for (const double w : weights) marks.push_back(w > excess.mean() ? 1.0 : 0.0);
    const double marked = std::accumulate(marks.begin(), marks.end(), 0.0);
    // The figure that slices are ranked by is the one that is held against chance.
    const std::vector<double>& looked = trace ? marks : weights;
    const auto score = [&](std::span<const double> values, const Slice& slice) {
      return trace ? overlap(values, marked, slice) : excess(values, slice);
    };
    std::vector<double> by_chance(orders.size(), 0.0);
    for (std::size_t b = 0; b < orders.size(); ++b) {
      if (cancelled()) return {};
      const std::vector<double> permuted = in_order(looked, orders[b]);
      for (const Slice& slice : slices) by_chance[b] = std::max(by_chance[b], score(permuted, slice));
    }
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (const Slice& slice : slices) {
      const double own = score(looked, slice);
      const auto above =
          std::count_if(by_chance.begin(), by_chance.end(), [own](double x) { return x >= own; });
      const double p = (1.0 + static_cast<double>(above)) / (1.0 + static_cast<double>(by_chance.size()));
      if (p > kSignificant) continue;
      const double data = static_cast<double>(slice.windows.size()) / static_cast<double>(of.squares.size());
      scored.push_back({{slice.conditions, of.channel, sum_in(weights, slice) / sum, data, p},
                        trace ? share * own : own,
                        &slice});
    }
  }
  std::stable_sort(scored.begin(), scored.end(),
                   [](const Scored& a, const Scored& b) { return a.rank > b.rank; });
  std::vector<const Scored*> kept;
  std::vector<Regime> regimes;
  for (const Scored& s : scored) {
    if (regimes.size() >= most) break;
    if (std::any_of(kept.begin(), kept.end(), [&](const Scored* k) { return much_the_same(*k, s); }))
      continue;
    kept.push_back(&s);
    regimes.push_back(s.regime);
  }
  return regimes;
}

}  // namespace slipway::gap
