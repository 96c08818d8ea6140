#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "gap/diagnosis/model/hypothesis.h"
#include "gap/diagnosis/model/smooth_difference.h"
#include "gap/diagnosis/model/window_model.h"

namespace slipway::gap {

// The directions of the difference between model and drives that a reference teaches: smooth functions of
// what a window met (smooth_difference.h), and what the tracks of other wheels change, which no smooth
// function has: a wheel stands in them or beside them, as the rover slides and turns. Where another
// simulator's tracks are not fresh soil either, that is no change since the reference. It is what `multipass`
// does with a usual and with a large stiffening, in each channel by itself.
//
// Observations x coefficients, at nuisances x; `expected`: predicted there without any difference. The number
// and the meaning of the columns depend on the rover's wheels alone.
Eigen::MatrixXd difference_columns(const WindowModel& model, std::span<const double> x,
                                   std::span<const double> expected, const SmoothScale& scale,
                                   std::size_t threads);

// The group of each: smooth_groups(), and for each channel one of what tracks change.
std::vector<std::size_t> difference_groups(const sim::RoverModel& rover);

}  // namespace slipway::gap
