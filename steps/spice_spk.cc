#include "steps/spice_spk.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace slipway::steps {
namespace {

constexpr int kPositions = 2;
constexpr int kPositionsAndVelocities = 3;
constexpr std::size_t kMiddleAndHalf = 2;  // words of an interval before its coefficients
constexpr std::size_t kLastWords = 4;      // of a segment: start, length, words of an interval, intervals
constexpr int kEqualSteps = 8;
constexpr int kLagrange = 9;
constexpr int kHermite = 13;
constexpr std::size_t kStateWords = 6;
constexpr std::size_t kEpochsOfDirectory = 100;
constexpr double kMetresOfKilometre = 1000.0;
// What lies beyond is neither in the solar system nor in its time: such numbers come of a damaged file.
constexpr double kFarthestM = 1e15;
constexpr double kMostSeconds = 1e12;
constexpr double kShortestInterval_s = 1e-3;

// How many states a segment says to have, where that agrees with its length; 0 where it does not.
std::size_t states_of(int type, const std::vector<double>& words) {
  if (words.size() < 2) return 0;
  const double said = words.back();
  if (!(said >= 1.0 && said <= static_cast<double>(words.size())) || said != std::floor(said)) return 0;
  const auto n = static_cast<std::size_t>(said);
  const std::size_t length =
      type == kEqualSteps ? kStateWords * n + 4 : kStateWords * n + n + (n - 1) / kEpochsOfDirectory + 2;
  return length == words.size() ? n : 0;
}

// A whole number from 1 to the words that there are; 0 where it is none.
std::size_t count_within(double stored, std::size_t most) {
  const bool good = stored >= 1.0 && stored <= static_cast<double>(most) && stored == std::floor(stored);
  return good ? static_cast<std::size_t>(stored) : 0;
}

// Sum of c_k T_k(x), and its derivative by x.
struct Sum {
  double value = 0.0, slope = 0.0;
};
Sum chebyshev(const double* c, std::size_t n, double x) {
  // Clenshaw's recurrence, and the same of its derivative.
  double b1 = 0.0, b2 = 0.0, d1 = 0.0, d2 = 0.0;
  for (std::size_t k = n; k-- > 1;) {
    const double d = 2.0 * b1 + 2.0 * x * d1 - d2, b = 2.0 * x * b1 - b2 + c[k];
    d2 = std::exchange(d1, d);
    b2 = std::exchange(b1, b);
  }
  return {x * b1 - b2 + c[0], b1 + x * d1 - d2};
}

}  // namespace

bool is_readable_spk(const DafArray& array) {
  const int type = array.whole[3];
  return type == kEqualSteps || type == kLagrange || type == kHermite;
}

Result<SpkSegment> read_spk_segment(const DafFile& daf, const DafArray& array) {
  const int type = array.whole[3];
  if (!is_readable_spk(array)) return daf.refuse(array, 0, "only SPK types 8, 9 and 13 are read");
  const std::vector<double> words = daf.words_of(array);
  const std::size_t n = states_of(type, words);
  if (n == 0) return daf.refuse(array, words.size() - 1, "the number of states does not fit the segment");
  SpkSegment segment{
      array.name, array.whole[0], array.whole[1], array.whole[2], array.numbers[0], array.numbers[1], {}};
  segment.states.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    SpkState& state = segment.states[k];
    for (std::size_t c = 0; c < 3; ++c) {
      state.position_m[c] = kMetresOfKilometre * words[kStateWords * k + c];
      if (!(std::abs(state.position_m[c]) <= kFarthestM))
        return daf.refuse(array, kStateWords * k + c, "a position is no number or beyond the solar system");
    }
    const std::size_t times = kStateWords * n;
    const std::size_t at = type == kEqualSteps ? times : times + k;
    state.et_s =
        type == kEqualSteps ? words[times] + static_cast<double>(k) * words[times + 1] : words[times + k];
    if (!(std::abs(state.et_s) <= kMostSeconds))
      return daf.refuse(array, at, "a time is no number or beyond 1e12 s");
    if (k > 0 && state.et_s < segment.states[k - 1].et_s)
      return daf.refuse(array, at, "a time is before the one that precedes it");
  }
  return segment;
}

bool has_polynomials(const DafArray& array) {
  return array.whole[3] == kPositions || array.whole[3] == kPositionsAndVelocities;
}

Result<SpkPolynomials> read_spk_polynomials(const DafFile& daf, const DafArray& array) {
  constexpr double kSlack = 1e-6;  // of an interval: ends are rounded
  if (!has_polynomials(array)) return daf.refuse(array, 0, "only SPK types 2 and 3 are read here");
  SpkPolynomials of{array.name,
                    array.whole[0],
                    array.whole[1],
                    array.whole[2],
                    array.numbers[0],
                    array.numbers[1],
                    0.0,
                    1.0,
                    0,
                    0,
                    daf.words_of(array)};
  const std::size_t size = of.words.size();
  if (size <= kLastWords) return daf.refuse(array, 0, "the segment has no interval");
  const double* const last = of.words.data() + size - kLastWords;
  of.first_et_s = last[0];
  of.interval_s = last[1];
  of.record_words = count_within(last[2], size);
  const std::size_t intervals = count_within(last[3], size);
  if (!(std::abs(of.first_et_s) <= kMostSeconds))
    return daf.refuse(array, size - 4, "a time is no number or beyond 1e12 s");
  if (!(of.interval_s >= kShortestInterval_s && of.interval_s <= kMostSeconds))
    return daf.refuse(array, size - 3, "the length of the intervals must be 0.001 s to 1e12 s");
  if (intervals == 0 || of.record_words != (size - kLastWords) / intervals ||
      of.record_words * intervals + kLastWords != size)
    return daf.refuse(array, size - 1, "the number of intervals does not fit the segment");
  const std::size_t sums = array.whole[3] == kPositions ? 3 : 6;
  of.coefficients = (of.record_words - std::min(of.record_words, kMiddleAndHalf)) / sums;
  if (of.coefficients == 0 || of.coefficients * sums + kMiddleAndHalf != of.record_words)
    return daf.refuse(array, size - 2, "the number of coefficients does not fit the interval");
  for (std::size_t k = 0; k < intervals; ++k) {
    const std::size_t at = k * of.record_words;
    const double middle = of.words[at], half = of.words[at + 1];
    const double from = of.first_et_s + of.interval_s * static_cast<double>(k);
    const double slack = kSlack * of.interval_s;
    if (!(std::abs(middle - half - from) <= slack && std::abs(middle + half - from - of.interval_s) <= slack))
      return daf.refuse(array, at, "an interval is not where the segment's start and length put it");
    for (std::size_t c = kMiddleAndHalf; c < of.record_words; ++c)
      if (!(std::abs(of.words[at + c]) <= kFarthestM / kMetresOfKilometre))
        return daf.refuse(array, at + c, "a coefficient is no number or beyond the solar system");
  }
  const double end_et_s = of.first_et_s + of.interval_s * static_cast<double>(intervals);
  if (of.start_et_s > of.end_et_s || of.start_et_s < of.first_et_s - kSlack * of.interval_s ||
      of.end_et_s > end_et_s + kSlack * of.interval_s)
    return daf.refuse(array, size - 4, "the segment's times go beyond its intervals");
  return of;
}

SpkMotion SpkPolynomials::at(double et_s) const {
  const std::size_t intervals = (words.size() - kLastWords) / record_words;
  const double since = std::floor((et_s - first_et_s) / interval_s);
  const auto k = static_cast<std::size_t>(std::clamp(since, 0.0, static_cast<double>(intervals - 1)));
  const double* const record = words.data() + k * record_words;
  const double x = std::clamp((et_s - record[0]) / record[1], -1.0, 1.0);
  SpkMotion motion;
  for (int c = 0; c < 3; ++c) {
    const Sum sum =
        chebyshev(record + kMiddleAndHalf + static_cast<std::size_t>(c) * coefficients, coefficients, x);
    motion.position_m[c] = kMetresOfKilometre * sum.value;
    motion.velocity_m_s[c] = kMetresOfKilometre * sum.slope / record[1];
  }
  return motion;
}

}  // namespace slipway::steps
