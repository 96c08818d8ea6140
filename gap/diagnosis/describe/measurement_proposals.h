#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "gap/diagnosis/result/result.h"
#include "gap/diagnosis/search/diagnosis_options.h"
#include "gap/diagnosis/search/explanation_search.h"

namespace slipway::gap {

// Of each effect that these drives would not surely have shown at its usual size
// (VerdictOptions::surely_seen): the fewest kinds of re-tuned parameters that, known from elsewhere, would
// leave enough of its trace. Nothing of an effect that no such measurement uncovers: then it is of one class
// with what can't be measured. `whitened`: of a change of every observation, rows weighed as in the fit of
// nothing.
using Whitening = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;
std::vector<MeasurementProposal> measurement_proposals(const ExplanationSearch& search,
                                                       const Whitening& whitened,
                                                       const VerdictOptions& options);

}  // namespace slipway::gap
