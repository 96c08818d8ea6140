#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnosis/model/reference_belief.h"
#include "gap/diagnosis/model/window_model.h"

namespace slipway::gap {

// What the windows of a reference have left over: measured less what was learnt of it.
std::vector<SeenWindow> seen_windows(const WindowModel& reference, const Eigen::VectorXd& residuals);

// What drives repeat of a reference's: of each observation, what is left over there as in the reference's
// window of the same command at the same place, in the part that repeats. Of a channel (of a wheel) the mean
// over all such windows repeats in full, and the rest by the regression of `residuals` on it, within 0 and 1:
// all of it where what is left over is of the ground, nothing where it is noise. A change that is the same in
// all windows is in no part of it. 0 where the reference has no such window, or a channel has few of them.
// residuals: of every observation, what the smooth difference leaves.
Eigen::VectorXd repeated_part(const std::vector<SeenWindow>& seen, const WindowModel& model,
                              const Eigen::VectorXd& residuals);

}  // namespace slipway::gap
