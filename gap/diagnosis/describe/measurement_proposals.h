#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/diagnosis_options.h"
#include "gap/diagnosis/search/explanation_search.h"

namespace slipway::gap {

// A change of every observation, whitened, with rows weighed as in the fit of nothing.
using Whitening = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

// Of each effect that these drives would not surely have shown at its usual size
// (DescriptionOptions::surely_seen): the first of these kinds of re-tuned parameters that, known from
// elsewhere, would leave enough of its trace: motors; sensors; soil; motors and soil; soil and closures;
// motors, soil and closures. An effect without a proposal is too weak on these drives at its usual size, or
// hidden behind what none of these measures.
std::vector<MeasurementProposal> measurement_proposals(const ExplanationSearch& search,
                                                       const Whitening& whitened,
                                                       const DescriptionOptions& options);

}  // namespace slipway::gap
