#pragma once

#include <cstddef>

#include "sim/prediction/drive_prediction.h"

namespace slipway::planner {

// How many draws of the ground decide a drive where a request does not say it: the first, and the most that
// are taken until the bars decide. Plans, checks and predictions of one drive take the same draws.
constexpr int kFirstDraws = 32;
constexpr int kMostDraws = 1000;

// The options with which a drive of this length and number of stations is predicted, whoever asks: from
// kLongDrive_m on it is decided in segments of kSegment_m where no other length is asked for, and where the
// number of draws is open there are fewer, since each takes longer: 16 at first, and in all no more than have
// 300,000 stations together.
sim::RiskOptions risk_of_drive(const sim::RiskOptions& asked, double length_m, std::size_t stations);

}  // namespace slipway::planner
