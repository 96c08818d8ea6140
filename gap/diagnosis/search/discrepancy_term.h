#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnosis/search/explanation.h"

namespace slipway::gap {

// Where a discrepancy that nobody has named could enter, and what it could depend on: the explanation called
// "something else", which competes with the effects on equal terms [Brynjarsdottir & O'Hagan 2014].
//
// A column is what an entry point does to every observation, at the fit, times a function of the window's
// circumstances: a constant pull, a pull that grows with the slope, a current that is wrong when cold.
struct DiscrepancyTerm {
  struct Column {
    std::string entry;     // "tangential_force"
    std::string variable;  // "constant", "pitch", "slip", ...
  };
  std::vector<Column> columns;
  Eigen::MatrixXd values;  // observations x columns, for a coefficient of the size that would matter
};

// What a window's drive met, each about 1 in size where it matters: slope, slip, direction, ...
struct Circumstance {
  std::string_view name;  // "constant", "pitch", "slip", ...
  double value = 0.0;
};
// Of every window, slip being the predicted one.
std::vector<std::vector<Circumstance>> circumstances(const WindowModel& model,
                                                     std::span<const double> expected);

// What the levers do to every observation at a null fit's parameters: derivatives by the pitch and roll under
// which weights act (a force along, a force across; rad), by the centre of mass forward and to the left (m),
// and by the angle at which steered wheels stand (rad).
Eigen::MatrixXd lever_responses(const DriveCampaign& campaign, const WindowModel& model,
                                std::span<const double> null_x, std::size_t threads);
constexpr int kLevers = 5;

DiscrepancyTerm make_discrepancy_term(const DriveCampaign& campaign, const WindowModel& model,
                                      const FittedExplanation& fit, std::size_t threads);

// Its whitened columns, rows weighed as in the fit.
Eigen::MatrixXd whitened(const FittedExplanation& fit, const NoiseModel& noise,
                         const DiscrepancyTerm& discrepancy);

// No simulator is exact: every explanation has the wildcard beside it up to this size, and only more than
// that is something else.
constexpr double kImprecision = 0.1;

// That an effect is at work does not say that its equation is the library's: what it does to the observations
// may be off by this share, differently by circumstance, axle and kind of channel.
constexpr double kFormImprecision = 0.3;

// The columns, whitened, by which the effects of a fit may be off: what each of them does there, times
// functions of the circumstances. None where the fit has no effects.
Eigen::MatrixXd form_columns(const DriveCampaign& campaign, const WindowModel& model, const NoiseModel& noise,
                             const FittedExplanation& fit, std::size_t threads);

// By how much the logarithm of a fitted explanation's evidence rises with the wildcard beside it, averaged
// over sizes from none to kImprecision, and over larger ones; the effects' forms are averaged over likewise.
struct DiscrepancyGain {
  double imprecision = 0.0, something_else = 0.0;
};
// `form`: of form_columns.
DiscrepancyGain discrepancy_gain(const FittedExplanation& fit, const NoiseModel& noise,
                                 const DiscrepancyTerm& discrepancy, const Eigen::MatrixXd& form);

// The fit's whitened columns with the form's and the wildcard's behind, these at their most probable sizes
// among those that discrepancy_gain averages over.
Eigen::MatrixXd columns_beside(const FittedExplanation& fit, const NoiseModel& noise,
                               const DiscrepancyTerm& discrepancy, const Eigen::MatrixXd& form,
                               bool something_else);

// The coefficients' means and standard errors, in units of the columns, at the most probable size.
struct DiscrepancyEstimate {
  Eigen::VectorXd mean, error;
};
DiscrepancyEstimate estimate_discrepancy(const FittedExplanation& fit, const NoiseModel& noise,
                                         const DiscrepancyTerm& discrepancy);

}  // namespace slipway::gap
