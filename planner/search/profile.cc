#include "planner/search/profile.h"

#include <array>

namespace slipway::planner {
namespace {

Weights balanced(const Weights& asked) {
  return asked;
}

// A little slip and risk stay in, so that a way over hopeless ground is not the shortest one.
Weights shortest(const Weights& asked) {
  return {.duration = 1.0, .energy = 0.0, .slip = 0.1 * asked.slip, .unknown = 0.0, .risk = 0.1 * asked.risk};
}

Weights least_slip(const Weights& asked) {
  return {.duration = 0.2,
          .energy = 0.2 * asked.energy,
          .slip = 10.0,
          .unknown = asked.unknown,
          .risk = asked.risk};
}

Weights least_risk(const Weights& asked) {
  return {.duration = 0.3, .energy = 0.3 * asked.energy, .slip = asked.slip, .unknown = 8.0, .risk = 100.0};
}

}  // namespace

std::span<const Profile> profiles() {
  static constexpr std::array<Profile, 4> kProfiles{{
      {"balanced", "the request's own weights", balanced},
      {"shortest", "duration, with a tenth of the weight on slip and risk", shortest},
      {"least_slip", "slip before all else", least_slip},
      {"least_risk", "risk and unknown ground before all else", least_risk},
  }};
  return kProfiles;
}

}  // namespace slipway::planner
