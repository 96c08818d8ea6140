#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/result.h"
#include "gap/estimate/least_squares.h"
#include "validation/cuadriga/cuadriga_model.h"
#include "validation/cuadriga/cuadriga_windows.h"
#include "validation/cuadriga/log_scatter.h"

namespace slipway::validation {

// What is estimated, in this order: ln k_phi, net traction, ln K, torque per ampere, idle current, returned
// share. Net traction is tan(friction angle) less the rolling resistance, about the steepest gradient that
// the soil allows. Between the bounds the rover climbs every gradient of the table, as Cuadriga did, so that
// the search meets straight bounds and not a crooked edge beyond which there is no answer. k_phi of 1e6 is a
// sinkage of 3.5 cm, the most that is believed of these wheels.
std::vector<gap::Unknown> cuadriga_unknowns();
CuadrigaParameters parameters_of(std::span<const double> unknowns);

// Gradient as logged along the path and turn rate of the window.
ClimbConditions conditions_of(const CuadrigaWindow& window);

struct CuadrigaFit {
  gap::LeastSquaresFit search;
  CuadrigaModel model;
  // Of the training logs: measured - predicted, and ln of measured over predicted.
  LogScatter slip, log_charge;
  // Of the parameters, of the two at a gradient.
  double slip_std(const ClimbConditions& conditions) const;
  double log_charge_std(const ClimbConditions& conditions) const;
  // Models one standard step up and down in each unknown, and the steps.
  std::vector<std::pair<CuadrigaModel, CuadrigaModel>> neighbours;
  std::vector<double> steps;
};

// Of ln k_phi, tan(friction angle) and ln K.
Eigen::Matrix3d soil_covariance(const CuadrigaFit& fit);

// Fits slip and current of the windows, those whose positions jump left out. A residual counts in units of
// the scatter of its gradient, softened for outliers, with the weight of its log (weights_by_log): first with
// scatter as guessed, then as it was found.
// Errors: those of fit_least_squares.
Result<CuadrigaFit> fit_cuadriga(const sim::RoverModel& rover, const std::vector<CuadrigaWindow>& windows);

}  // namespace slipway::validation
