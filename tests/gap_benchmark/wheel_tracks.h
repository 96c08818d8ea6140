#pragma once

#include <array>
#include <vector>

#include "rover_balance.h"

namespace slipway::gap_benchmark {

// The tracks of the wheels: lanes to the left of a common line and stations along it, in the direction of
// travel.
struct Tracks {
  std::array<double, kWheels> lane_m{}, station_m{};

  bool is_ahead(int wheel, int of) const {
    return wheel != of &&
           station_m[static_cast<std::size_t>(wheel)] >= station_m[static_cast<std::size_t>(of)] + kMinLead_m;
  }
  static constexpr double kMinLead_m = 0.2;
};
Tracks tracks_of(const RoverOnFile& rover, const BalanceState& state);

// The soil that a wheel meets: undisturbed soil changed by the ruts of the wheels ahead, from the foremost
// on, where their tracks overlap. Empty where there are no ruts.
std::vector<SoilNode> soil_met(int wheel, const Tracks& tracks, const std::array<Rut, kWheels>& ruts,
                               double width_m);

}  // namespace slipway::gap_benchmark
