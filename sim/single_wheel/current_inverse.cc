#include "sim/single_wheel/current_inverse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/quantile.h"
#include "core/random.h"

namespace slipway::sim {
namespace {

WheelRigResult at_slip(WheelRigConditions test, double slip) {
  test.slip = slip;
  return run_wheel_rig(test);
}

// Current less what was measured; nothing where the wheel is sunk.
std::optional<double> surplus(const WheelRigConditions& test, double slip, double current_a) {
  const WheelRigResult result = at_slip(test, slip);
  if (!result.stands() || !result.current_a) return std::nullopt;
  return *result.current_a - current_a;
}

// The root between two slips of different sign, by halving.
double root_between(const WheelRigConditions& test, double current_a, double low, double high, bool rising) {
  while (high - low > 1e-10) {
    const double middle = 0.5 * (low + high);
    const auto value = surplus(test, middle, current_a);
    if (!value) break;
    ((*value > 0.0) == rising ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

SlipQuantiles quantiles_of(WheelRigConditions test, const SoilDistribution& belief, double current_a,
                           const InverseOptions& options) {
  SlipQuantiles q;
  q.draws = options.draws;
  std::vector<double> slips;
  int over = 0;
  for (int d = 0; d < options.draws; ++d) {
    const std::uint64_t key = random_key(options.seed, static_cast<std::uint64_t>(d));
    SoilNormals normals;
    for (int k = 0; k < kSoilDims; ++k) normals[k] = random_normal(key, static_cast<std::uint64_t>(k));
    test.soil = draw_soil(belief, normals);
    const SlipsOfCurrent found = slips_of_current(test, current_a);
    if (found.reported) {
      slips.push_back(*found.reported);
      over += *found.reported > options.max_slip ? 1 : 0;
    } else if (!found.stands || current_a > found.greatest_current_a) {
      ++q.above;
    } else {
      ++q.below;
    }
  }
  q.solved = static_cast<int>(slips.size());
  if (options.draws > 0) q.risk = static_cast<double>(over + q.above) / static_cast<double>(options.draws);
  if (slips.empty()) return q;
  q.p05 = quantile(slips, 0.05);
  q.p50 = quantile(slips, 0.50);
  q.p95 = quantile(slips, 0.95);
  return q;
}

// Why no slip explains the current.
std::string no_slip(double current_a, const SlipsOfCurrent& found) {
  if (!found.stands)
    return "no slip explains it: the wheel is sunk to its axle under this load at every slip";
  return fmt::format(
      "no slip in [{:.2f}, {:.2f}] explains {:.3f} A: this soil and load ask for {:.3f} to {:.3f} A; {}",
      kMinSearchedSlip, kMaxSearchedSlip, current_a, found.least_current_a, found.greatest_current_a,
      current_a > found.greatest_current_a
          ? "the wheel meets more than this soil gives, or soil or load are others"
          : "the ground drives the wheel, or soil or load are others");
}

// GO, CAUTION or NO-GO, and why.
void judge(double current_a, const InverseOptions& options, CurrentInverse& answer) {
  const SlipsOfCurrent& found = answer.found;
  std::vector<std::string>& words = answer.words;
  if (found.sunk_from_slip)
    words.push_back(fmt::format("the wheel is sunk to its axle from slip {:.2f} on", *found.sunk_from_slip));
  if (!found.reported) {
    const bool above = !found.stands || current_a > found.greatest_current_a;
    answer.verdict = above ? Trafficability::kNoGo : Trafficability::kUnknown;
    words.push_back(no_slip(current_a, found));
    return;
  }
  const double slip = *found.reported;
  const SlipQuantiles& q = answer.quantiles;
  if (found.slips.size() > 1) {
    std::string all;
    for (const double one : found.slips) all += fmt::format("{}{:.3f}", all.empty() ? "" : ", ", one);
    words.push_back(
        fmt::format("slips of {} ask for the same current: the first on the rising branch is reported", all));
  }
  if (slip > options.max_slip) {
    answer.verdict = Trafficability::kNoGo;
    words.push_back(fmt::format("no_go: slip {:.2f} is above the limit {:.2f}", slip, options.max_slip));
  } else if (q.risk > options.accepted_risk || found.slips.size() > 1) {
    answer.verdict = Trafficability::kUnknown;
    words.push_back(
        fmt::format("unknown: slip {:.2f} is within the limit {:.2f}; {:.0f} % of {} soil draws are above "
                    "it, {:.0f} % are "
                    "accepted",
                    slip, options.max_slip, 100.0 * q.risk, q.draws, 100.0 * options.accepted_risk));
  } else {
    answer.verdict = Trafficability::kGo;
    words.push_back(
        fmt::format("go: slip {:.2f} is within the limit {:.2f}, as it is under {:.0f} % of {} soil draws",
                    slip, options.max_slip, 100.0 * (1.0 - q.risk), q.draws));
  }
}

void measure_reserve(const WheelRigConditions& test, CurrentInverse& answer) {
  answer.greatest = greatest_pull(test);
  if (!answer.found.reported || !answer.greatest) return;
  answer.wheel = at_slip(test, *answer.found.reported);
  const double pull = answer.wheel->forces.drawbar_pull_n;
  if (answer.greatest->pull_n <= 0.0) {
    answer.words.push_back(
        fmt::format("the wheel can't pull at any slip: {:.1f} N of resistance are left at best",
                    -answer.greatest->pull_n));
  } else if (pull <= 0.0) {
    answer.words.push_back(fmt::format("at this slip the wheel pulls nothing: {:.1f} N push it", -pull));
  } else {
    answer.share_of_pull = pull / answer.greatest->pull_n;
  }
  answer.slope_in_use_rad = std::atan2(pull, test.load_n);
  answer.slope_greatest_rad = std::atan2(answer.greatest->pull_n, test.load_n);
  answer.slope_left_rad = *answer.slope_greatest_rad - *answer.slope_in_use_rad;
}

}  // namespace

SlipsOfCurrent slips_of_current(const WheelRigConditions& test, double current_a) {
  SlipsOfCurrent found;
  std::optional<double> before;
  double slip_before = 0.0;
  const auto steps = std::lround((kMaxSearchedSlip - kMinSearchedSlip) / kSearchedSlipStep);
  for (long k = 0; k <= steps; ++k) {
    const double slip = kMinSearchedSlip + static_cast<double>(k) * kSearchedSlipStep;
    const auto here = surplus(test, slip, current_a);
    if (here) {
      const double current = *here + current_a;
      found.least_current_a = found.stands ? std::min(found.least_current_a, current) : current;
      found.greatest_current_a = found.stands ? std::max(found.greatest_current_a, current) : current;
      found.stands = true;
      if (before && (*before > 0.0) != (*here > 0.0)) {
        const bool rising = *here > 0.0;
        found.slips.push_back(root_between(test, current_a, slip_before, slip, rising));
        if (rising && !found.reported) found.reported = found.slips.back();
      }
    } else if (found.stands && !found.sunk_from_slip) {
      found.sunk_from_slip = slip;
    }
    before = here;
    slip_before = slip;
  }
  return found;
}

std::optional<GreatestPull> greatest_pull(const WheelRigConditions& test) {
  std::optional<GreatestPull> best;
  const auto try_slip = [&](double slip) {
    const WheelRigResult result = at_slip(test, slip);
    if (result.stands() && (!best || result.forces.drawbar_pull_n > best->pull_n))
      best = GreatestPull{slip, result.forces.drawbar_pull_n};
  };
  const auto steps = std::lround(kMaxSearchedSlip / kSearchedSlipStep);
  for (long k = 0; k <= steps; ++k) try_slip(static_cast<double>(k) * kSearchedSlipStep);
  // Closer around the best, step by step.
  for (double step = 0.5 * kSearchedSlipStep; best && step > 1e-6; step *= 0.5) {
    const double centre = best->slip;
    for (const double slip : {centre - step, centre + step})
      if (slip >= 0.0 && slip <= kMaxSearchedSlip) try_slip(slip);
  }
  return best;
}

std::string_view describe(Trafficability verdict) {
  switch (verdict) {
    case Trafficability::kGo:
      return "go";
    case Trafficability::kUnknown:
      return "unknown";
    case Trafficability::kNoGo:
      break;
  }
  return "no_go";
}

CurrentInverse invert_current(const WheelRigConditions& test, const SoilDistribution& belief,
                              double current_a, const InverseOptions& options) {
  CurrentInverse answer;
  WheelRigConditions mean = test;
  mean.soil = belief.mean;
  answer.found = slips_of_current(mean, current_a);
  answer.quantiles = quantiles_of(test, belief, current_a, options);
  judge(current_a, options, answer);
  measure_reserve(mean, answer);
  return answer;
}

}  // namespace slipway::sim
