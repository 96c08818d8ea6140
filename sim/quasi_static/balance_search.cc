#include "sim/quasi_static/balance_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "sim/wheel/entry_angle.h"

namespace slipway::sim {
namespace {

using Vector = RoverBalance::Vector;
constexpr int kMotions = RoverBalance::kMotions;
constexpr double kMinEntryAngleRad = RoverBalance::kMinEntryAngleRad;

constexpr double kMaxSpeedRatio = 3.0;  // a rover that is faster than this times its wheels slides away
constexpr double kTouchingEntryAngleRad = 0.05;
constexpr std::array<double, 3> kColdStartSpeedRatios{0.9, 0.6, 0.3};
constexpr double kClearance_m = 1e-9;  // a wheel this far into the ground still counts as hanging

// A cold start: entry angles for the resting loads by Bekker's closed form, and the primary motion at a share
// of the commanded one. Also sets the wheels in the air that carry no load at rest.
Vector cold_start(RoverBalance& balance, const Primary& primary, double share) {
  Vector x = Vector::Zero(kMotions + balance.wheel_count());
  x[primary.motion] = primary.sign * share;
  const RoverBalance::Loads loads = balance.resting_loads_n();
  for (int k = 0; k < balance.wheel_count(); ++k) {
    if (balance.in_air(k)) continue;
    const WheelGeometry& wheel = balance.wheel_geometry(k);
    const double load = std::max(loads[k], 0.02 * balance.weight_n());
    x[kMotions + k] = entry_angle_rad(wheel.radius_m, bekker_sinkage_m(wheel, balance.soil(k), load));
  }
  keep_in_range(x);
  return x;
}

// The reason why no balance was found, judged by the last iterate.
Attempt reason_of(const RoverBalance& balance, const Vector& x) {
  if (x.head<kMotions>().cwiseAbs().maxCoeff() > kMaxSpeedRatio) return {Outcome::kNoTraction, -1};
  for (int k = 0; k < balance.wheel_count(); ++k)
    if (x[kMotions + k] > 0.95 * kMaxEntryAngleRad) return {Outcome::kSunkToAxle, k};
  for (int k = 0; k < balance.wheel_count(); ++k)
    if (!balance.in_air(k) && x[kMotions + k] < 10.0 * kMinEntryAngleRad) return {Outcome::kWheelLifted, k};
  return {Outcome::kNotConverged, -1};
}

// The slow and certain method. The net force along the commanded motion falls as the rover goes faster, so
// that its zero can be bracketed. Where the force is negative even at full spin, there is no traction; where
// it is still positive at three times the wheels' speed, the rover slides away.
Attempt bracketed(RoverBalance& balance, const Primary& primary, Vector& x) {
  const auto push_at = [&](double ratio, Vector& state) -> std::optional<double> {
    state[primary.motion] = primary.sign * ratio;
    if (!newton(balance, state, &primary, 60)) return std::nullopt;
    return primary.sign * balance.residual(state)[primary.equation];
  };
  constexpr std::array<double, 7> kRatios{kSpinningSpeedRatio, 0.2, 0.5, 0.8, 1.0, 1.5, kMaxSpeedRatio};
  std::optional<double> slower_ratio;
  Vector state = x;
  bool solved_any = false;
  for (const double ratio : kRatios) {
    Vector trial = state;
    const std::optional<double> push = push_at(ratio, trial);
    x = trial;
    if (!push) continue;
    solved_any = true;
    state = trial;
    if (*push <= 0.0) {
      if (!slower_ratio) return {Outcome::kNoTraction, -1};
      double low = *slower_ratio, high = ratio;
      for (int iteration = 0; iteration < 60 && high - low > 1e-12; ++iteration) {
        Vector full = state;
        if (newton(balance, full, nullptr, 20)) {
          x = full;
          return {};
        }
        const double middle = 0.5 * (low + high);
        const std::optional<double> there = push_at(middle, state);
        if (!there) return reason_of(balance, state);
        (*there > 0.0 ? low : high) = middle;
      }
      x = state;
      return {};
    }
    slower_ratio = ratio;
  }
  return solved_any && slower_ratio == kMaxSpeedRatio ? Attempt{Outcome::kNoTraction, -1}
                                                      : reason_of(balance, x);
}

// The wheel in the air that cuts deepest into the ground, if there is one.
std::optional<int> wheel_to_set_down(const RoverBalance& balance, const Vector& x) {
  std::optional<int> deepest;
  double lowest = -kClearance_m;
  for (int k = 0; k < balance.wheel_count(); ++k) {
    if (!balance.in_air(k)) continue;
    const double height = balance.height_in_air_m(k, x);
    if (height >= lowest) continue;
    lowest = height;
    deepest = k;
  }
  return deepest;
}

// The wheel whose load would have to be negative, which happens to wheels dragged through cohesive soil.
std::optional<int> pulling_wheel(const RoverBalance& balance) {
  std::optional<int> lightest;
  double least = -kBalanceTolerance * balance.weight_n();
  for (int k = 0; k < balance.wheel_count(); ++k) {
    const double load = balance.contact(k).forces.vertical_n;
    if (load >= least) continue;
    least = load;
    lightest = k;
  }
  return lightest;
}

// After a search that failed: the wheel with hardly any contact with the ground.
std::optional<int> hardly_touching_wheel(const RoverBalance& balance, const Vector& x) {
  std::optional<int> lightest;
  double least = 3.0 * kMinEntryAngleRad;
  for (int k = 0; k < balance.wheel_count(); ++k) {
    if (balance.in_air(k) || x[kMotions + k] > least) continue;
    least = x[kMotions + k];
    lightest = k;
  }
  return lightest;
}

struct ContactChange {
  int wheel = -1;
  bool into_air = false;
};

// The change that the set of wheels in contact needs after a search; empty where the set is right or where no
// other can be tried.
std::optional<ContactChange> contact_change(const RoverBalance& balance, const Vector& x, bool solved) {
  if (solved) {
    if (const std::optional<int> deepest = wheel_to_set_down(balance, x))
      return ContactChange{*deepest, false};
  }
  if (!balance.can_spare_a_wheel()) return std::nullopt;
  const std::optional<int> wheel = solved ? pulling_wheel(balance) : hardly_touching_wheel(balance, x);
  return wheel ? std::optional(ContactChange{*wheel, true}) : std::nullopt;
}

// The outcome of a solution. In a solution beyond full spin the rover slides back against its wheels, and in
// one with a pulling wheel that wheel lifts.
Attempt judged(const RoverBalance& balance, const Primary& primary, const Vector& x) {
  if (x[primary.motion] * primary.sign < kSpinningSpeedRatio) return {Outcome::kNoTraction, -1};
  if (const std::optional<int> wheel = pulling_wheel(balance)) return {Outcome::kWheelLifted, *wheel};
  return {};
}

// Sets the entry angles that belong to the wheels in contact: the minimum for a wheel in the air, and a small
// one for a wheel that was just set down.
Vector with_contacts(const RoverBalance& balance, Vector x) {
  for (int k = 0; k < balance.wheel_count(); ++k) {
    double& theta = x[kMotions + k];
    if (balance.in_air(k)) {
      theta = kMinEntryAngleRad;
    } else if (theta <= kMinEntryAngleRad) {
      theta = kTouchingEntryAngleRad;
    }
  }
  return x;
}

void forget(NewtonMemory& memory) {
  memory.inverse.reset();
  memory.slopes.reset();
}

// Newton's search, repeated with other sets of wheels in contact until every wheel in contact pushes on the
// ground and every other is clear of it. Returns false where that ends without a balance. `memory` is for
// all wheels in contact.
bool find_in_contact(RoverBalance& balance, int max_iterations, Vector& x, NewtonMemory* memory = nullptr) {
  const Vector start = x;
  for (int round = 0; round <= 2 * balance.wheel_count(); ++round) {
    const bool all = balance.all_in_contact();
    const bool solved = newton(balance, x, nullptr, max_iterations, all ? memory : nullptr);
    if (!all && memory != nullptr) forget(*memory);
    const std::optional<ContactChange> change = contact_change(balance, x, solved);
    if (!change) return solved;
    balance.set_in_air(change->wheel, change->into_air);
    x = with_contacts(balance, solved ? x : start);
  }
  return false;
}

// The same with the slow and certain method in Newton's place.
Attempt bracketed_in_contact(RoverBalance& balance, const Primary& primary, Vector& x) {
  const Vector start = x;
  for (int round = 0; round <= 2 * balance.wheel_count(); ++round) {
    const Attempt attempt = bracketed(balance, primary, x);
    std::optional<ContactChange> change;
    if (attempt.outcome == Outcome::kMoving) change = contact_change(balance, x, true);
    if (attempt.outcome == Outcome::kWheelLifted && balance.can_spare_a_wheel())
      change = ContactChange{attempt.wheel, true};
    if (!change) return attempt.outcome == Outcome::kMoving ? judged(balance, primary, x) : attempt;
    balance.set_in_air(change->wheel, change->into_air);
    x = with_contacts(balance, start);
  }
  return {Outcome::kNotConverged, -1};
}

// For wheels whose shares in tracks change so much with the motion that the other searches go to and fro. The
// shares are held while the balance is found, and follow its motion half way, until a search finds the
// balance with shares that follow.
Attempt with_held_tracks(RoverBalance& balance, const Primary& primary, Vector& x) {
  constexpr int kMaxRounds = 20;
  x = cold_start(balance, primary, kColdStartSpeedRatios[0]);
  for (int round = 0; round < kMaxRounds; ++round) {
    balance.hold_tracks(x, 0.5);
    Attempt held;
    if (!find_in_contact(balance, 40, x)) {
      x = cold_start(balance, primary, kColdStartSpeedRatios[0]);
      held = bracketed_in_contact(balance, primary, x);
    }
    balance.release_tracks();
    if (held.outcome != Outcome::kMoving) return held;
    Vector following = x;
    if (!find_in_contact(balance, 20, following)) continue;
    x = following;
    return judged(balance, primary, x);
  }
  return {Outcome::kNotConverged, -1};
}

// The wheel that the ground would have to hold down even while the rover rests: past its tipping angle no
// soil that only pushes has a balance.
std::optional<int> wheel_that_lifts_at_rest(RoverBalance& balance) {
  const RoverBalance::Loads loads = balance.resting_loads_n();
  Eigen::Index lightest = 0;
  if (loads.minCoeff(&lightest) >= -kBalanceTolerance * balance.weight_n()) return std::nullopt;
  return static_cast<int>(lightest);
}

}  // namespace

Primary primary_of(const DriveCommand& command) {
  if (command.turn_in_place) return {2, 5, command.turn_rate_rad_s < 0.0 ? -1.0 : 1.0};
  return {0, 0, command.speed_m_s < 0.0 ? -1.0 : 1.0};
}

Attempt find_balance(RoverBalance& balance, const Primary& primary, bool warm, Vector& x,
                     NewtonMemory* memory, Thoroughness thoroughness) {
  const bool few = memory != nullptr && memory->max_iterations > 0;
  if (!balance.any_driven()) {
    x = cold_start(balance, primary, 0.0);
    return {Outcome::kNoTraction, -1};
  }
  if (warm) {
    if (balance.can_spare_a_wheel()) {
      balance.resting_loads_n();  // for the wheels that hang
      x = with_contacts(balance, x);
    }
    if (find_in_contact(balance, few ? memory->max_iterations : 20, x, memory))
      return judged(balance, primary, x);
  }
  // The soil forces on a failed wheel change sign within a thousandth of the speed. There the first start
  // often fails where another finds the balance.
  if (memory != nullptr) forget(*memory);
  const std::span<const double> starts(kColdStartSpeedRatios.data(), balance.all_driven() ? 1 : 3);
  for (const double share : starts) {
    x = cold_start(balance, primary, share);
    if (find_in_contact(balance, few ? memory->max_iterations : 40, x, memory))
      return judged(balance, primary, x);
  }
  if (thoroughness == Thoroughness::kQuick) return {Outcome::kNotConverged, -1};
  x = cold_start(balance, primary, kColdStartSpeedRatios[0]);
  const Attempt attempt = bracketed_in_contact(balance, primary, x);
  if (attempt.outcome != Outcome::kNotConverged) return attempt;
  if (const std::optional<int> wheel = wheel_that_lifts_at_rest(balance))
    return {Outcome::kWheelLifted, *wheel};
  return balance.follows_tracks() ? with_held_tracks(balance, primary, x) : attempt;
}

}  // namespace slipway::sim
