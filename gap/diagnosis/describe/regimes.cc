#include "gap/diagnosis/describe/regimes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>
#include <optional>

#include "core/random.h"
#include "gap/diagnosis/search/random_streams.h"

namespace slipway::gap {
namespace {

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

// None far off above the largest that more windows have than a slice needs: what fewer do is no slice, and
// one that a model calls stuck would outweigh all others.
std::vector<double> limited(std::span<const double> squares, const DiagnosisOptions& options) {
  std::vector<double> all(squares.begin(), squares.end());
  const std::size_t least = least_of_slice(all.size(), options.slices);
  if (all.size() <= least) return all;
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(least), all.end(),
                   std::greater<double>());
  const double most = std::max(all[least], options.location.plainly_off);
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

// The slices of one channel, by the figure that they are ranked by: the same figure of all slices in permuted
// windows is what chance does.
class ChannelRegimes {
 public:
  ChannelRegimes(const ChannelSquares& of, std::span<const Slice> slices, double share, LookedAt looked_at,
                 const DiagnosisOptions& options)
      : channel_(of.channel),
        share_(share),
        trace_(looked_at == LookedAt::kTrace),
        options_(options.location),
        recorded_(of.squares),
        weights_(trace_ ? limited(recorded_.squares(), options) : recorded_.squares()),
        excess_(weights_) {
    for (const double w : weights_) marks_.push_back(w > excess_.mean() ? 1.0 : 0.0);
    marked_ = std::accumulate(marks_.begin(), marks_.end(), 0.0);
    const std::size_t least = least_of_slice(weights_.size(), options.slices);
    const double most = options.slices.max_share * static_cast<double>(weights_.size());
    for (const Slice& slice : slices) {
      Slice here = recorded_.of(slice);
      if (here.windows.size() >= least && static_cast<double>(here.windows.size()) <= most)
        slices_.push_back({&slice, std::move(here)});
    }
  }

  // Whether there is something to look for: more than noise or, of a trace, a good share of it.
  bool worth_a_slice() const {
    return excess_.variance() > 0.0 &&
           (excess_.mean() >= 1.0 || (trace_ && share_ >= options_.min_trace_share));
  }

  // The largest score of a slice, and in each of so many permutations of drives. Nothing where it was
  // cancelled.
  std::optional<LargestScores> largest(std::span<const std::size_t> drive_of, std::uint64_t seed,
                                       std::size_t permutations,
                                       const std::function<bool()>& cancelled) const {
    const std::vector<std::size_t> drives = recorded_.of(drive_of);
    const auto largest_of = [this](std::span<const double> values) {
      double largest = 0.0;
      for (const Recorded& slice : slices_) largest = std::max(largest, score(values, slice.here));
      return largest;
    };
    LargestScores scores{largest_of(looked()), {}};
    for (std::size_t b = 0; b < permutations; ++b) {
      if (cancelled()) return std::nullopt;
      scores.by_chance.push_back(
          largest_of(in_order(looked(), reordered(drives, random_key(seed, kSliceOrders + b)))));
    }
    return scores;
  }

  // Those whose p is small enough.
  std::vector<Scored> significant(const std::function<double(double own)>& p_of) const {
    const double sum = std::accumulate(weights_.begin(), weights_.end(), 0.0);
    std::vector<Scored> scored;
    for (const auto& [slice, here] : slices_) {
      const double own = score(looked(), here);
      const double p = p_of(own);
      if (p > options_.max_significance) continue;
      const double data = static_cast<double>(here.windows.size()) / static_cast<double>(weights_.size());
      scored.push_back({{slice->conditions, channel_, sum_in(weights_, here) / sum, data, p},
                        trace_ ? share_ * own : own,
                        slice});
    }
    return scored;
  }

 private:
  struct Recorded {
    const Slice* slice;
    Slice here;  // by the numbers of the recorded windows
  };

  const std::vector<double>& looked() const { return trace_ ? marks_ : weights_; }
  double score(std::span<const double> values, const Slice& slice) const {
    return trace_ ? overlap(values, marked_, slice) : excess_(values, slice);
  }

  Channel channel_;
  double share_;
  bool trace_;
  const LocationOptions& options_;
  RecordedWindows recorded_;
  std::vector<double> weights_;
  Excess excess_;
  std::vector<Recorded> slices_;
  std::vector<double> marks_;
  double marked_ = 0.0;
};

// The best first, each that is not much the same as a better one.
std::vector<Regime> best_apart(std::vector<Scored> scored, std::size_t most) {
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

}  // namespace

RecordedWindows::RecordedWindows(std::span<const double> squares) : number_(squares.size()) {
  for (std::size_t w = 0; w < squares.size(); ++w) {
    if (std::isnan(squares[w])) continue;
    number_[w] = windows_.size();
    windows_.push_back(w);
    squares_.push_back(squares[w]);
  }
}

Slice RecordedWindows::of(const Slice& slice) const {
  Slice here{slice.conditions, {}};
  for (const std::size_t w : slice.windows)
    if (number_[w]) here.windows.push_back(*number_[w]);
  return here;
}

JointSignificance::JointSignificance(std::vector<LargestScores> groups) {
  if (groups.empty()) return;
  for (const LargestScores& group : groups) {
    sorted_.push_back(group.by_chance);
    std::sort(sorted_.back().begin(), sorted_.back().end());
  }
  const std::size_t permutations = groups.front().by_chance.size();
  rarest_.assign(permutations, permutations + 1);
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (std::size_t b = 0; b < permutations; ++b) {
      // What was observed is one of the draws.
      const double drawn = groups[g].by_chance[b];
      const std::size_t rank = as_large(g, drawn) + (groups[g].observed >= drawn ? 1 : 0);
      rarest_[b] = std::min(rarest_[b], rank);
    }
}

std::size_t JointSignificance::as_large(std::size_t group, double score) const {
  const std::vector<double>& scores = sorted_[group];
  return static_cast<std::size_t>(scores.end() - std::lower_bound(scores.begin(), scores.end(), score));
}

double JointSignificance::operator()(std::size_t group, double own) const {
  const std::size_t rank = as_large(group, own) + 1;
  const auto as_rare =
      std::count_if(rarest_.begin(), rarest_.end(), [rank](std::size_t r) { return r <= rank; });
  return (1.0 + static_cast<double>(as_rare)) / (1.0 + static_cast<double>(rarest_.size()));
}

Excess::Excess(std::span<const double> values) {
  if (values.empty()) return;
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

std::vector<ChannelShare> shares_of(std::span<const ChannelSquares> channels,
                                    const DiagnosisOptions& options) {
  std::vector<ChannelShare> shares;
  double total = 0.0;
  for (const ChannelSquares& of : channels) {
    const std::vector<double> weights = limited(RecordedWindows(of.squares).squares(), options);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (sum > 0.0) shares.push_back({of.channel, sum});
    total += sum;
  }
  for (ChannelShare& share : shares) share.share /= total;
  std::stable_sort(shares.begin(), shares.end(),
                   [](const ChannelShare& a, const ChannelShare& b) { return a.share > b.share; });
  return shares;
}

double p_of_permutations(double own, std::span<const double> by_chance) {
  const auto above = std::count_if(by_chance.begin(), by_chance.end(), [own](double x) { return x >= own; });
  return (1.0 + static_cast<double>(above)) / (1.0 + static_cast<double>(by_chance.size()));
}

std::size_t permutation_count(const DiagnosisOptions& options) {
  return static_cast<std::size_t>(options.resamples) /
             static_cast<std::size_t>(options.location.resamples_per_permutation) +
         1;
}

std::vector<Regime> regimes_in(std::span<const Slice> slices, std::span<const ChannelSquares> channels,
                               std::span<const std::size_t> drive_of, LookedAt looked_at,
                               const DiagnosisOptions& options, const std::function<bool()>& cancelled) {
  const std::vector<ChannelShare> shares = shares_of(channels, options);
  std::vector<ChannelRegimes> looked_at_channels;
  std::vector<LargestScores> scores;
  for (const ChannelSquares& of : channels) {
    double share = 0.0;
    for (const ChannelShare& s : shares)
      if (s.channel == of.channel) share = s.share;
    ChannelRegimes regimes(of, slices, share, looked_at, options);
    if (!regimes.worth_a_slice()) continue;
    auto largest = regimes.largest(drive_of, options.seed, permutation_count(options), cancelled);
    if (!largest) return {};
    scores.push_back(std::move(*largest));
    looked_at_channels.push_back(std::move(regimes));
  }
  const JointSignificance p(std::move(scores));
  std::vector<Scored> scored;
  for (std::size_t c = 0; c < looked_at_channels.size(); ++c) {
    std::vector<Scored> found = looked_at_channels[c].significant([&p, c](double own) { return p(c, own); });
    std::move(found.begin(), found.end(), std::back_inserter(scored));
  }
  return best_apart(std::move(scored), static_cast<std::size_t>(options.location.max_regimes));
}

}  // namespace slipway::gap
