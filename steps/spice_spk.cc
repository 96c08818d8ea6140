#include "steps/spice_spk.h"

#include <cmath>

namespace slipway::steps {
namespace {

constexpr int kEqualSteps = 8;
constexpr int kLagrange = 9;
constexpr int kHermite = 13;
constexpr std::size_t kStateWords = 6;
constexpr std::size_t kEpochsOfDirectory = 100;
constexpr double kMetresOfKilometre = 1000.0;
// What lies beyond is neither in the solar system nor in its time: such numbers come of a damaged file.
constexpr double kFarthestM = 1e15;
constexpr double kMostSeconds = 1e12;

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

}  // namespace slipway::steps
