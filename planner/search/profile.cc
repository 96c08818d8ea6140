#include "planner/search/profile.h"

#include <array>

namespace slipway::planner {
namespace {

// A little slip and risk stay in, so that a way over hopeless ground is not the shortest one.
constexpr std::array<ProfileWeight, 5> kShortest{{{"duration", 0.0, 1.0},
                                                  {"energy", 0.0, 0.0},
                                                  {"slip", 0.1, 0.0},
                                                  {"unknown", 0.0, 0.0},
                                                  {"risk", 0.1, 0.0}}};
constexpr std::array<ProfileWeight, 3> kMinSlip{
    {{"duration", 0.0, 0.2}, {"energy", 0.2, 0.0}, {"slip", 0.0, 10.0}}};
constexpr std::array<ProfileWeight, 4> kMinRisk{
    {{"duration", 0.0, 0.3}, {"energy", 0.3, 0.0}, {"unknown", 0.0, 8.0}, {"risk", 0.0, 100.0}}};

}  // namespace

Weights Profile::weights(const Weights& asked) const {
  Weights weights = asked;
  for (const ProfileWeight& row : changed)
    weights.set(row.term, row.share_of_asked * asked.of(row.term) + row.fixed);
  return weights;
}

std::span<const Profile> profiles() {
  static constexpr std::array<Profile, 4> kProfiles{{
      {"balanced", "the request's own weights", {}},
      {"shortest", "duration, with a tenth of the weight on slip and risk", kShortest},
      {"least_slip", "slip before all else", kMinSlip},
      {"least_risk", "risk and unknown ground before all else", kMinRisk},
  }};
  return kProfiles;
}

}  // namespace slipway::planner
