#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "api/chart/chart.h"

namespace slipway::validation {

// A predicted probability, and in how many of how many trials it came about.
struct PredictedShare {
  double predicted = 0.0;
  double came_about = 0.0, trials = 0.0;
};

// Predictions of about one probability, means weighted by trials.
struct ReliabilityBin {
  double lowest = 0.0, highest = 0.0;  // of the predicted probability; the last bin holds its end
  std::size_t predictions = 0;
  double trials = 0.0, predicted = 0.0, came_about = 0.0;
};

struct Calibration {
  std::vector<ReliabilityBin> bins;  // without those that hold nothing
  double share = 0.0;                // of all trials, that came about
  double brier = 0.0;                // mean square of probability less outcome [Brier 1950]
  double constant_brier = 0.0;       // of the share of all trials as everybody's prediction
  // Mean over trials of the difference between predicted and executed share of their bin [Naeini et al.
  // 2015].
  double expected_error = 0.0;
};

// The edges rise from 0 to 1. There must be a trial.
Calibration calibration_of(std::span<const PredictedShare> shares, std::span<const double> edges);

// Executed against predicted shares of the bins, with the diagonal.
api::Chart reliability_chart(const std::string& title, const Calibration& calibration);

}  // namespace slipway::validation
