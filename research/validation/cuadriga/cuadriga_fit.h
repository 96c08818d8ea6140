#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/result.h"
#include "gap/estimate/least_squares.h"
#include "research/validation/cuadriga/cuadriga_model.h"
#include "research/validation/cuadriga/cuadriga_windows.h"
#include "research/validation/cuadriga/log_scatter.h"

namespace slipway::validation {

// The estimated parameters, in this order: ln k_phi, net traction, ln K, torque per ampere, idle current,
// returned share. Net traction is tan(friction angle) less the rolling resistance, which is about the
// steepest gradient that the soil allows. Between the bounds the rover climbs every gradient of the table, as
// Cuadriga did, so that the search meets straight bounds and no curved edge beyond which there is no answer.
// A k_phi of 1e6 gives a sinkage of 3.5 cm, which is taken as the maximum for these wheels.
std::vector<gap::Unknown> cuadriga_unknowns();
CuadrigaParameters parameters_of(std::span<const double> unknowns);

// The gradient as logged along the path, and the turn rate of the window.
ClimbConditions conditions_of(const CuadrigaWindow& window);

struct CuadrigaFit {
  gap::LeastSquaresFit search;
  CuadrigaModel model;
  // Scatter of the training logs: of measured - predicted slip, and of ln(measured / predicted charge).
  LogScatter slip, log_charge;
  // Standard deviations of the two predictions due to the parameters' uncertainty.
  double slip_std(const ClimbConditions& conditions) const;
  double log_charge_std(const ClimbConditions& conditions) const;
  // Models one standard step up and down in each unknown, and the steps.
  std::vector<std::pair<CuadrigaModel, CuadrigaModel>> neighbours;
  std::vector<double> steps;
};

// The covariance of ln k_phi, tan(friction angle) and ln K.
Eigen::Matrix3d soil_covariance(const CuadrigaFit& fit);

// Fits slip and current of the windows, except those whose positions jump. Residuals are in units of the
// scatter at their gradient, with a robust loss, and have the weights of their logs (weights_by_log). The fit
// is made with a guessed scatter first, then with the one found. Errors: those of fit_least_squares.
Result<CuadrigaFit> fit_cuadriga(const sim::RoverModel& rover, const std::vector<CuadrigaWindow>& windows);

}  // namespace slipway::validation
