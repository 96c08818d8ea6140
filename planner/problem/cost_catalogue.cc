#include "planner/problem/cost_catalogue.h"

#include <array>

namespace slipway::planner {
namespace {

double hours(const DriveFigures& drive) {
  return drive.duration_s / 3600.0;
}
double hundred_watt_hours(const DriveFigures& drive) {
  return drive.energy_j / 360'000.0;
}
double hundred_metres_of_slip(const DriveFigures& drive) {
  return drive.slip_length_m / 100.0;
}
double hundred_metres_unknown(const DriveFigures& drive) {
  return drive.unknown_length_m / 100.0;
}
double risk(const DriveFigures& drive) {
  return drive.risk;
}

}  // namespace

DriveFigures figures_of(const sim::DrivePrediction& prediction) {
  return {.length_m = prediction.length_m,
          .turned_rad = prediction.turned_rad,
          .duration_s = prediction.duration_s,
          .energy_j = prediction.energy_j,
          .slip_length_m = prediction.mean_slip_ratio * prediction.length_m,
          .unknown_length_m = prediction.unknown_length_m,
          .risk = prediction.risk};
}

std::span<const CostTerm> cost_catalogue() {
  static constexpr std::array<CostTerm, 5> kRows{{
      {"duration",
       "time under way with the mean soils",
       {"duration", "1/h", "cost of an hour", 0.0, 1000.0, 1.0},
       "h",
       hours},
      {"energy",
       "electric energy of the drive motors",
       {"energy", "1/(100 Wh)", "cost of 100 Wh", 0.0, 1000.0, 1.0},
       "100 Wh",
       hundred_watt_hours},
      {"slip",
       "mean slip over the length, times the length",
       {"slip", "1/(100 m)", "cost of 100 m at 100 % slip", 0.0, 1000.0, 4.0},
       "100 m",
       hundred_metres_of_slip},
      {"unknown",
       "length driven with any wheel on unknown ground",
       {"unknown", "1/(100 m)", "cost of 100 m on unknown ground", 0.0, 1000.0, 2.0},
       "100 m",
       hundred_metres_unknown},
      {"risk",
       "share of soil draws in which a limit is broken or the rover immobilised",
       {"risk", "1", "cost of certainly breaking a limit", 0.0, 1000.0, 20.0},
       "1",
       risk},
  }};
  return kRows;
}

}  // namespace slipway::planner
