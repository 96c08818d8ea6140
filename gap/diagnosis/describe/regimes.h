#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "gap/diagnosis/describe/slices.h"
#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/diagnosis_options.h"

namespace slipway::gap {

// What a channel has in each window: the mean square over its wheels, in deviations of the noise; NaN where
// the window has no reading of the channel.
struct ChannelSquares {
  Channel channel = Channel::kSlip;
  std::vector<double> squares;
};

// The windows that have a reading of a channel, counted from 0: what is not recorded is not small.
class RecordedWindows {
 public:
  explicit RecordedWindows(std::span<const double> squares);
  const std::vector<double>& squares() const { return squares_; }
  // A value of each window of all, of these windows only.
  template <typename T>
  std::vector<T> of(std::span<const T> values) const {
    std::vector<T> here;
    for (const std::size_t w : windows_) here.push_back(values[w]);
    return here;
  }
  // The slice's windows that are among these, by their new numbers.
  Slice of(const Slice& slice) const;

 private:
  std::vector<double> squares_;
  std::vector<std::size_t> windows_;                // of all windows, those that are here
  std::vector<std::optional<std::size_t>> number_;  // of each of all windows, its number here
};

// Of squared deviations: `gap` is of prediction less measurement, `trace` of what effects do, which has no
// noise.
enum class LookedAt { kGap, kTrace };

// Slices of one and two conditions whose windows hold more of a channel than of the data, best first, p at
// most LocationOptions::max_significance by permuting drives (the best of all slices of all channels). A
// channel is looked at in the windows that have a reading of it. Of a gap by how far they stand out, in
// channels above their noise. Of a trace by how nearly they are the windows above the channel's mean
// (intersection over union), times the channel's share, in channels that have min_trace_share of it or are
// above their noise. `drive_of`: of each window. None where it was cancelled.
std::vector<Regime> regimes_in(std::span<const Slice> slices, std::span<const ChannelSquares> channels,
                               std::span<const std::size_t> drive_of, LookedAt looked_at,
                               const DiagnosisOptions& options, const std::function<bool()>& cancelled);

// Each channel's share of a trace, the largest first; none where there are none. Here and above, the few
// windows of a trace that are further off than all others, beyond LocationOptions::plainly_off, weigh no more
// than the next.
std::vector<ChannelShare> shares_of(std::span<const ChannelSquares> channels,
                                    const DiagnosisOptions& options = {});

// The windows in another order: drives permuted, the whole turned round, so that neighbours stay neighbours.
std::vector<std::size_t> reordered(std::span<const std::size_t> drive_of, std::uint64_t key);

// How many permutations of drives are made.
std::size_t permutation_count(const DiagnosisOptions& options);

// The probability that chance alone does as well: (1 + how many of those by chance are at least as large) /
// (1 + how many there are) [Phipson & Smyth 2010, Statistical Applications in Genetics 9].
double p_of_permutations(double own, std::span<const double> by_chance);

// What a group of scores has, and what chance gives it.
struct LargestScores {
  double observed = 0.0;
  std::vector<double> by_chance;  // in each permutation
};

// p of scores in several groups that are looked at together: the probability that chance has, in any of them,
// a score as rare in its group [min-p of Westfall & Young 1993, Resampling-Based Multiple Testing, 2.3]. Of
// one group it is p_of_permutations. All groups have as many permutations.
class JointSignificance {
 public:
  explicit JointSignificance(std::vector<LargestScores> groups);
  // `own`: a score of the group, at most its largest.
  double operator()(std::size_t group, double own) const;

 private:
  // How many permutations of a group have at least this score.
  std::size_t as_large(std::size_t group, double score) const;

  std::vector<std::vector<double>> sorted_;  // by chance, of each group
  std::vector<std::size_t> rarest_;          // the least rank of each permutation over the groups, from 1
};

// By how many deviations of as many windows drawn at random a slice's mean is above the mean of all.
class Excess {
 public:
  explicit Excess(std::span<const double> values);
  double mean() const { return mean_; }
  double variance() const { return variance_; }
  // `values` may be in another order.
  double operator()(std::span<const double> values, const Slice& slice) const;

 private:
  double mean_ = 0.0, variance_ = 0.0;
};

}  // namespace slipway::gap
