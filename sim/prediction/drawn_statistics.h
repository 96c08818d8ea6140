#pragma once

#include <vector>

#include "sim/prediction/drawn_drive.h"

namespace slipway::sim {

// Fills the prediction's shares, intervals and percentiles of the whole drive from its draws; there must be
// one.
void summarise(const std::vector<DrawnDrive>& drives, const std::vector<PreparedStation>& stations,
               const DriveLimits& limits, DrivePrediction& prediction);

// Fills the percentiles and the risk of station `s` from the draws that reached it.
void fill_station(const std::vector<DrawnDrive>& drives, std::size_t s, StationPrediction& station);

// Fills the expected stops and the share of embeddings of every station.
void fill_events(const std::vector<DrawnDrive>& drives, std::vector<StationPrediction>& stations);

}  // namespace slipway::sim
