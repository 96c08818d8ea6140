#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/result.h"
#include "research/validation/cuadriga/cuadriga_fit.h"

namespace slipway::validation {

// The prediction of a quantity of a window before it is driven: median, 50 and 90 % intervals.
struct Prediction {
  double median = 0.0, low_50 = 0.0, high_50 = 0.0, low_90 = 0.0, high_90 = 0.0;

  bool holds_50(double value) const { return value >= low_50 && value <= high_50; }
  bool holds_90(double value) const { return value >= low_90 && value <= high_90; }
};

Prediction predict_slip(const CuadrigaFit& fit, const ClimbConditions& conditions);
Prediction predict_charge(const CuadrigaFit& fit, const ClimbConditions& conditions, double wheel_speed_m_s);

// Predictions that are simpler than a model: of the training windows the mean, the straight line in gradient,
// and the plane in gradient and magnitude of the turn rate, both by ordinary least squares.
struct Baselines {
  double mean = 0.0;
  Eigen::Vector2d line = Eigen::Vector2d::Zero();   // at 0, per rad of gradient
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();  // and per rad/s
};
Baselines baselines_of(const std::vector<CuadrigaWindow>& windows, double CuadrigaWindow::*quantity);

// The baselines' predictions for a window.
struct Simple {
  double mean = 0.0, line = 0.0, plane = 0.0;
};

// A window and its predictions by fits without its log.
struct HeldOut {
  CuadrigaWindow window;
  int fold = 0;
  Prediction slip, charge_as;
  Simple simple_slip, simple_charge_as;
};

struct CrossValidation {
  std::vector<HeldOut> windows;   // in the order given
  std::vector<CuadrigaFit> fits;  // of the folds
  CuadrigaFit of_all;             // of all logs; its parameters are shipped, but no score is taken from it
};

// Predicts every log once by a fit of the logs of the other folds. Windows whose positions jump are
// predicted, but not used for training. Errors: those of fit_cuadriga.
Result<CrossValidation> cross_validate(const sim::RoverModel& rover,
                                       const std::vector<CuadrigaWindow>& windows, int folds);

}  // namespace slipway::validation
