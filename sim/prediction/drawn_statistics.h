#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "sim/prediction/drawn_drive.h"

namespace slipway::sim {

// Wilson's interval for a share of n draws, at 90 % [Wilson 1927].
DrawnShare share_of_draws(double share, double n);

// Fills the mean of the stops with its 90 % interval: mean and mean of the squares of n draws, of which
// out.stop is the share that stops.
void fill_expected_stops(double mean, double square, double n, DriveOutcomes& out);

// The 5th, 50th and 95th percentile of values with weights; there must be a weight.
DrawnSpread spread_of(std::vector<std::pair<double, double>> values);

// The ground that a station stands for: unknown where any wheel is on unknown ground.
std::optional<std::size_t> ground_of(const PreparedStation& station);

// Fills the prediction's shares, intervals and percentiles of the whole drive from its draws; there must be
// one.
void summarise(const std::vector<DrawnDrive>& drives, const std::vector<PreparedStation>& stations,
               const DriveLimits& limits, double segment_m, DrivePrediction& prediction);

// Fills the percentiles and the risk of station `s` from the draws that reached it.
void fill_station(const std::vector<DrawnDrive>& drives, std::size_t s, StationPrediction& station);

// Fills the expected stops and the share of embeddings of every station.
void fill_events(const std::vector<DrawnDrive>& drives, std::vector<StationPrediction>& stations);

}  // namespace slipway::sim
