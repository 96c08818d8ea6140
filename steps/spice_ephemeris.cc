#include "steps/spice_ephemeris.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/utc.h"

namespace slipway::steps {
namespace {

constexpr int kBarycentre = 0;
constexpr int kJ2000Frame = 1;
// Of a body from a body, up to the barycentre: of a rover's site there are five.
constexpr int kLongestChain = 32;

// To the minute, in TDB, which is a minute and nine seconds ahead of UTC.
std::string tdb_words(double et_s) {
  constexpr double kJ2000_ms = 946'728'000'000.0;
  constexpr double kFirst_ms = -6.2e13, kLast_ms = 2.5e14;  // between them a year has four digits
  const double ms = kJ2000_ms + 1000.0 * et_s;
  if (!(ms > kFirst_ms && ms < kLast_ms)) return fmt::format("{:.6g} s past J2000", et_s);
  std::string text = utc_text(std::llround(ms)).substr(0, 16);
  std::replace(text.begin(), text.end(), 'T', ' ');
  return text + " TDB";
}

// The times of some segments as few spans, in words.
std::string spans_words(std::vector<std::pair<double, double>> spans) {
  constexpr std::size_t kMost = 5;
  std::sort(spans.begin(), spans.end());
  std::vector<std::pair<double, double>> joined;
  for (const auto& span : spans)
    if (!joined.empty() && span.first <= joined.back().second)
      joined.back().second = std::max(joined.back().second, span.second);
    else
      joined.push_back(span);
  std::vector<std::string> words;
  for (std::size_t k = 0; k < std::min(joined.size(), kMost); ++k)
    words.push_back(fmt::format("{} to {}", tdb_words(joined[k].first), tdb_words(joined[k].second)));
  if (joined.size() > kMost) words.push_back(fmt::format("{} more spans", joined.size() - kMost));
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

std::string body_words(int body) {
  constexpr std::array<std::pair<int, std::string_view>, 7> kNames{
      {{0, "the barycentre of the solar system"},
       {3, "the barycentre of Earth and Moon"},
       {4, "the barycentre of Mars and its moons"},
       {10, "the sun"},
       {301, "the Moon"},
       {399, "the Earth"},
       {499, "Mars"}}};
  for (const auto& [number, name] : kNames)
    if (number == body) return fmt::format("{} (body {})", name, body);
  return fmt::format("body {}", body);
}

Result<SpiceEphemeris> SpiceEphemeris::read(std::span<const DafFile> files, std::set<int> bodies) {
  SpiceEphemeris found;
  for (std::size_t before = 0; before != bodies.size();) {
    before = bodies.size();
    for (const DafFile& daf : files)
      for (const DafArray& array : daf.arrays())
        if (bodies.contains(array.whole[0])) bodies.insert(array.whole[1]);
  }
  std::vector<Fault> faults;
  for (const DafFile& daf : files)
    for (const DafArray& array : daf.arrays()) {
      found.known_.insert(array.whole[0]);
      if (!bodies.contains(array.whole[0])) continue;
      if (!has_polynomials(array) || array.whole[2] != kJ2000Frame) {
        found.passed_over_.push_back(array);
        continue;
      }
      auto segment = read_spk_polynomials(daf, array);
      if (segment)
        found.segments_.push_back(std::move(*segment));
      else
        faults.insert(faults.end(), segment.error().faults.begin(), segment.error().faults.end());
    }
  if (!faults.empty())
    return fail(ErrorCode::kUnreadableData, "the SPICE kernels can't be read", std::move(faults));
  std::reverse(found.segments_.begin(), found.segments_.end());
  return found;
}

bool SpiceEphemeris::has(int body) const {
  return std::any_of(segments_.begin(), segments_.end(),
                     [body](const SpkPolynomials& segment) { return segment.target == body; });
}

Result<SpkMotion> SpiceEphemeris::motion(int body, double et_s) const {
  SpkMotion sum;
  for (int at = body, steps = 0; at != kBarycentre; ++steps) {
    const auto segment = std::find_if(segments_.begin(), segments_.end(), [&](const SpkPolynomials& of) {
      return of.target == at && et_s >= of.start_et_s && et_s <= of.end_et_s;
    });
    if (segment == segments_.end()) return missing(at, et_s);
    if (steps == kLongestChain)
      return fail(ErrorCode::kInvalidRequest,
                  fmt::format("the kernels give {} from a body that is given from it: nothing leads to {}",
                              body_words(at), body_words(kBarycentre)));
    const SpkMotion step = segment->at(et_s);
    sum.position_m += step.position_m;
    sum.velocity_m_s += step.velocity_m_s;
    at = segment->centre;
  }
  return sum;
}

tl::unexpected<Error> SpiceEphemeris::missing(int body, double et_s) const {
  std::vector<std::pair<double, double>> spans;
  for (const SpkPolynomials& segment : segments_)
    if (segment.target == body) spans.emplace_back(segment.start_et_s, segment.end_et_s);
  if (!spans.empty())
    return fail(ErrorCode::kInvalidRequest,
                fmt::format("the kernels don't have {} at {}: they have it from {}", body_words(body),
                            tdb_words(et_s), spans_words(std::move(spans))));
  for (const DafArray& array : passed_over_)
    if (array.whole[0] == body)
      return fail(
          ErrorCode::kInvalidRequest,
          fmt::format("the kernels have {} in a segment of type {} and frame {} only: types 2 and 3 in "
                      "frame 1 (J2000) are read",
                      body_words(body), array.whole[3], array.whole[2]));
  std::vector<std::string> others;
  for (const int other : known_) others.push_back(body_words(other));
  return fail(ErrorCode::kInvalidRequest, fmt::format("the kernels don't have {}: they have {}",
                                                      body_words(body), fmt::join(others, ", ")));
}

}  // namespace slipway::steps
