#include "steps/spice_ck.h"

#include <algorithm>
#include <cmath>

namespace slipway::steps {
namespace {

constexpr int kInstants = 1;
constexpr int kConstantRate = 2;
constexpr int kInterpolated = 3;
constexpr std::size_t kQuaternionWords = 4;
constexpr std::size_t kRateWords = 3;
constexpr std::size_t kDirectoryEvery = 100;
// Quaternions are written with seven digits or more.
constexpr double kUnitTolerance = 1e-3;
// No clock counts and no body turns beyond these: such numbers come of a damaged file.
constexpr double kMostTicks = 1e18;
constexpr double kMostTurn = 1e9;

std::size_t directory_of(std::size_t n) {
  return (n - 1) / kDirectoryEvery;
}

// Where the parts of a segment's words are.
struct Layout {
  std::size_t records = 0, record_words = 0, intervals = 0;
  std::size_t ticks = 0;   // first word of the ticks of the records
  std::size_t starts = 0;  // type 3: of the intervals' starts; type 2: of their ends
};

// A count that is stored as a number; 0 where it is none or more than there can be.
std::size_t count_of(double stored, std::size_t most) {
  const bool good = stored >= 1.0 && stored <= static_cast<double>(most) && stored == std::floor(stored);
  return good ? static_cast<std::size_t>(stored) : 0;
}

// No layout where the counts do not fit the length.
std::optional<Layout> layout_of(int type, bool rates, const std::vector<double>& words) {
  const std::size_t size = words.size();
  Layout at;
  at.record_words = kQuaternionWords + (rates ? kRateWords : 0);
  std::size_t length = 0;
  if (type == kConstantRate) {
    // Quaternion, angular velocity and seconds a tick, then starts and ends; the count follows from the
    // length.
    at.record_words = kQuaternionWords + kRateWords + 1;
    at.records = kDirectoryEvery * (size + 10) / (kDirectoryEvery * 10 + 1);
    if (at.records == 0) return std::nullopt;
    at.starts = (at.record_words + 1) * at.records;
    length = at.starts + at.records + directory_of(at.records);
  } else {
    at.records = count_of(words.back(), size);
    if (at.records == 0) return std::nullopt;
    length = (at.record_words + 1) * at.records + directory_of(at.records);
    at.starts = length;
    if (type == kInterpolated) {
      at.intervals = size < 2 ? 0 : count_of(words[size - 2], at.records);
      if (at.intervals == 0) return std::nullopt;
      length += at.intervals + directory_of(at.intervals) + 1;
    }
    length += 1;
  }
  at.ticks = at.record_words * at.records;
  return length == size ? std::optional<Layout>(at) : std::nullopt;
}

Result<void> read_records(const DafFile& daf, const DafArray& array, const std::vector<double>& words,
                          const Layout& at, CkSegment& segment) {
  segment.records.reserve(at.records);
  for (std::size_t k = 0; k < at.records; ++k) {
    const double* const w = words.data() + k * at.record_words;
    const Eigen::Quaterniond q(w[0], w[1], w[2], w[3]);
    if (!(std::abs(q.norm() - 1.0) < kUnitTolerance))
      return daf.refuse(array, k * at.record_words, "a quaternion is not of unit length");
    const double tick = words[at.ticks + k];
    if (!(std::abs(tick) <= kMostTicks))
      return daf.refuse(array, at.ticks + k, "a tick is no number or beyond 1e18");
    if (k > 0 && tick <= segment.records.back().tick)
      return daf.refuse(array, at.ticks + k, "a tick is not above the one that precedes it");
    segment.records.push_back({tick, q.normalized()});
  }
  return {};
}

Result<void> read_intervals(const DafFile& daf, const DafArray& array, const std::vector<double>& words,
                            const Layout& at, CkSegment& segment) {
  for (std::size_t k = 0; k < at.intervals; ++k) {
    const double start = words[at.starts + k];
    const bool rises = k == 0 || start > segment.interval_starts.back();
    if (!std::isfinite(start) || !rises)
      return daf.refuse(array, at.starts + k, "starts of intervals must rise");
    segment.interval_starts.push_back(start);
  }
  return {};
}

Result<void> read_turns(const DafFile& daf, const DafArray& array, const std::vector<double>& words,
                        const Layout& at, CkSegment& segment) {
  for (std::size_t k = 0; k < at.records; ++k) {
    const double* const w = words.data() + k * at.record_words + kQuaternionWords;
    const Eigen::Vector3d turn = Eigen::Vector3d(w[0], w[1], w[2]) * w[kRateWords];
    const double end = words[at.starts + k];
    if (!(turn.norm() <= kMostTurn))
      return daf.refuse(array, k * at.record_words + kQuaternionWords,
                        "a rate is no number or beyond 1e9 rad");
    if (!(end >= segment.records[k].tick) || !std::isfinite(end))
      return daf.refuse(array, at.starts + k, "an interval ends before it starts");
    segment.turn_per_tick.push_back(turn);
    segment.interval_ends.push_back(end);
  }
  return {};
}

// The body turns about the axis as the reference frame sees it: C(t) = C(0) R^T [NAIF, CK Required Reading,
// type 2].
Eigen::Quaterniond turned(const Eigen::Quaterniond& q, const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (angle == 0.0) return q;
  return q * Eigen::Quaterniond(Eigen::AngleAxisd(-angle, turn / angle));
}

std::size_t interval_of(const CkSegment& segment, double tick) {
  return static_cast<std::size_t>(
      std::upper_bound(segment.interval_starts.begin(), segment.interval_starts.end(), tick) -
      segment.interval_starts.begin());
}

}  // namespace

bool is_readable_ck(const DafArray& array) {
  return array.whole[2] >= kInstants && array.whole[2] <= kInterpolated;
}

Result<CkSegment> read_ck_segment(const DafFile& daf, const DafArray& array) {
  if (!is_readable_ck(array)) return daf.refuse(array, 0, "only CK types 1, 2 and 3 are read");
  const std::vector<double> words = daf.words_of(array);
  const std::optional<Layout> at = layout_of(array.whole[2], array.whole[3] != 0, words);
  if (!at) return daf.refuse(array, words.size() - 1, "the number of records does not fit the segment");
  CkSegment segment;
  segment.name = array.name;
  segment.instrument = array.whole[0];
  segment.reference = array.whole[1];
  segment.type = array.whole[2];
  segment.start_tick = array.numbers[0];
  segment.end_tick = array.numbers[1];
  if (auto read = read_records(daf, array, words, *at, segment); !read) return fail(read.error());
  if (segment.type == kInterpolated)
    if (auto read = read_intervals(daf, array, words, *at, segment); !read) return fail(read.error());
  if (segment.type == kConstantRate)
    if (auto read = read_turns(daf, array, words, *at, segment); !read) return fail(read.error());
  return segment;
}

std::optional<Eigen::Quaterniond> attitude_at(const CkSegment& segment, double tick, double tolerance) {
  const auto& records = segment.records;
  if (tick < segment.start_tick - tolerance || tick > segment.end_tick + tolerance) return std::nullopt;
  const auto after = std::upper_bound(records.begin(), records.end(), tick,
                                      [](double t, const CkRecord& record) { return t < record.tick; });
  const CkRecord* const left = after == records.begin() ? nullptr : &*(after - 1);
  const CkRecord* const right = after == records.end() ? nullptr : &*after;
  const double from_left = left ? tick - left->tick : tolerance + 1.0;
  const double to_right = right ? right->tick - tick : tolerance + 1.0;
  if (std::min(from_left, to_right) <= tolerance) return from_left <= to_right ? left->q : right->q;
  if (!left) return std::nullopt;
  if (segment.type == kConstantRate) {
    const auto k = static_cast<std::size_t>(left - records.data());
    if (tick > segment.interval_ends[k]) return std::nullopt;
    return turned(left->q, segment.turn_per_tick[k] * from_left);
  }
  if (segment.type != kInterpolated || !right) return std::nullopt;
  if (interval_of(segment, left->tick) != interval_of(segment, right->tick)) return std::nullopt;
  return left->q.slerp(from_left / (right->tick - left->tick), right->q);
}

}  // namespace slipway::steps
