#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "gap/explanation.h"

namespace slipway::gap {

// Where a discrepancy that nobody has named could enter, and what it could depend on: the explanation called
// "something else", which competes with the effects on equal terms [Brynjarsdottir & O'Hagan 2014].
//
// A column is what an entry point does to every observation, at the fit, times a function of the window's
// circumstances: a constant pull, a pull that grows with the slope, a current that is wrong when cold.
struct Wildcard {
  struct Column {
    std::string entry;     // "tangential_force"
    std::string variable;  // "constant", "pitch", "slip", ...
  };
  std::vector<Column> columns;
  Eigen::MatrixXd values;  // observations x columns, for a coefficient of the size that would matter
};

Wildcard make_wildcard(const DriveCampaign& campaign, const WindowModel& model, const FittedExplanation& fit,
                       std::size_t threads);

// By how much the logarithm of the evidence of a fitted explanation rises when the wildcard stands beside it,
// its coefficients averaged over normal priors of several sizes.
double wildcard_gain(const FittedExplanation& fit, const NoiseModel& noise, const Wildcard& wildcard);

// The coefficients' mean, in units of the columns, at the most probable size.
Eigen::VectorXd wildcard_coefficients(const FittedExplanation& fit, const NoiseModel& noise,
                                      const Wildcard& wildcard);

}  // namespace slipway::gap
