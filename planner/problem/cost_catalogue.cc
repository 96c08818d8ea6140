#include "planner/problem/cost_catalogue.h"

#include <algorithm>
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
double stops(const DriveFigures& drive) {
  return drive.expected_stops;
}
double embedding(const DriveFigures& drive) {
  return drive.embedding;
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
          .expected_stops = prediction.outcomes.expected_stops,
          .embedding = prediction.outcomes.embedding.share,
          .risk = prediction.risk};
}

DriveFigures figures_of(const sim::DrivePrediction& prediction, const sim::DrawFigures& draw) {
  DriveFigures figures = figures_of(prediction);
  const double rest =
      prediction.length_m > 0.0 ? std::max(0.0, 1.0 - draw.driven_m / prediction.length_m) : 0.0;
  figures.duration_s = draw.duration_s + rest * figures.duration_s;
  figures.energy_j = draw.energy_j + rest * figures.energy_j;
  figures.slip_length_m = draw.slip_length_m + rest * figures.slip_length_m;
  figures.expected_stops = draw.stops;
  figures.embedding = draw.embedded ? 1.0 : 0.0;
  figures.risk = draw.breaks_a_limit ? 1.0 : 0.0;
  return figures;
}

// A stop costs the rest of its sol. A rover drives for some 4 h of a sol: between the morning's downlink of
// the last drive with the new commands, and the afternoon's pass that must hear how it went.
constexpr double kDrivingHoursOfASol = 4.0;
// Opportunity needed sols 446 to 484 to come out of Purgatory, and Spirit never came out of Troy: 50 sols.
constexpr double kSolsOfAnEmbedding = 50.0;

std::span<const CostTerm> cost_catalogue() {
  static constexpr std::array<CostTerm, 7> kRows{{
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
      {"stops",
       "mean number of stops over the soil draws, each for a sol",
       {"stops", "1", "cost of a stop, as of the hours that a sol has for driving", 0.0, 1000.0,
        kDrivingHoursOfASol},
       "1",
       stops},
      {"embedding",
       "share of soil draws that end embedded",
       {"embedding", "1", "cost of certainly being embedded, as of 50 sols", 0.0, 100'000.0,
        kSolsOfAnEmbedding * kDrivingHoursOfASol},
       "1",
       embedding},
      {"risk",
       "share of soil draws in which a limit is broken or the rover immobilised",
       // What a broken limit leads to is a stop or an embedding, which have rows of their own. This is what
       // is left: that the drive is looked into, for an hour.
       {"risk", "1", "cost of certainly breaking a limit", 0.0, 1000.0, 1.0},
       "1",
       risk},
  }};
  return kRows;
}

}  // namespace slipway::planner
