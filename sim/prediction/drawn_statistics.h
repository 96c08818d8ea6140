#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "sim/prediction/drive_endings.h"

namespace slipway::sim {

// The 5th, 50th and 95th percentile of values with weights; there must be a weight.
DrawnSpread spread_of(std::vector<std::pair<double, double>> values);

// The ground that a station stands for: unknown where any wheel is on unknown ground.
std::optional<std::size_t> ground_of(const PreparedStation& station);

// Fills the prediction's shares, intervals and percentiles of the whole drive from its draws; there must be
// one.
void summarise(const std::vector<DrawnDrive>& drives, const std::vector<PreparedStation>& stations,
               const DriveLimits& limits, const RiskOptions& options, DrivePrediction& prediction);

// Fills the percentiles and the risk of station `s` from the draws that reached it.
void fill_station(const std::vector<DrawnDrive>& drives, std::size_t s, StationPrediction& station);

// Fills the shares of first halts and of embeddings of every station.
void fill_events(const std::vector<DrawnDrive>& drives, const Segments& segments,
                 std::vector<StationPrediction>& stations);

}  // namespace slipway::sim
