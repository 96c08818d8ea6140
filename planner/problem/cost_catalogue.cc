#include "planner/problem/cost_catalogue.h"

#include <array>

namespace slipway::planner {
namespace {

double hours(const sim::DrivePrediction& drive) {
  return drive.duration_s / 3600.0;
}
double hundred_watt_hours(const sim::DrivePrediction& drive) {
  return drive.energy_j / 360'000.0;
}
double hundred_metres_of_slip(const sim::DrivePrediction& drive) {
  return drive.mean_slip_ratio * drive.length_m / 100.0;
}
double hundred_metres_unknown(const sim::DrivePrediction& drive) {
  return drive.unknown_length_m / 100.0;
}
double risk(const sim::DrivePrediction& drive) {
  return drive.risk;
}

}  // namespace

std::span<const CostTerm> cost_catalogue() {
  static constexpr Weights kInitial{};
  static constexpr std::array<CostTerm, 5> kRows{{
      {"duration",
       "time under way with the mean soils",
       {"duration", "1/h", "cost of an hour", 0.0, 1000.0, kInitial.duration},
       "h",
       &Weights::duration,
       hours},
      {"energy",
       "electric energy of the drive motors",
       {"energy", "1/(100 Wh)", "cost of 100 Wh", 0.0, 1000.0, kInitial.energy},
       "100 Wh",
       &Weights::energy,
       hundred_watt_hours},
      {"slip",
       "mean slip over the length, times the length",
       {"slip", "1/(100 m)", "cost of 100 m at 100 % slip", 0.0, 1000.0, kInitial.slip},
       "100 m",
       &Weights::slip,
       hundred_metres_of_slip},
      {"unknown",
       "length driven with any wheel on unknown ground",
       {"unknown", "1/(100 m)", "cost of 100 m on unknown ground", 0.0, 1000.0, kInitial.unknown},
       "100 m",
       &Weights::unknown,
       hundred_metres_unknown},
      {"risk",
       "share of soil draws in which a limit is broken or the rover immobilised",
       {"risk", "1", "cost of certainly breaking a limit", 0.0, 1000.0, kInitial.risk},
       "1",
       &Weights::risk,
       risk},
  }};
  return kRows;
}

}  // namespace slipway::planner
