#pragma once

#include <Eigen/Core>
#include <string_view>

#include "gap/diagnosis/search/explanation.h"

namespace slipway::gap {

// What an effect of a fit does to every observation, all else as fitted: predicted with it less without it;
// 0 where either has no answer. An empty name: all effects of the fit together.
Eigen::VectorXd effect_trace(const FittedExplanation& fit, const WindowModel& model, std::string_view effect,
                             std::size_t threads);

}  // namespace slipway::gap
