#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "gap/diagnosis/model/noise_scales.h"

namespace slipway::gap {

// How likely residuals are under scales, with everything that systematic columns (prior deviation 1 each)
// could explain taken out, and what that changes by with the logarithms of the scales:
//
//   l = log N(r; 0, C) + n/2 log(2 pi),   C = V + A A^T,   V that of NoiseModel
//   dl/dk = (a^T V_k a - tr(C^-1 V_k)) / 2,   a = C^-1 r,   V_k = dV / d log(scale k)
//
// and with the average of the observed and the expected information, (V_k a)^T C^-1 (V_l a) / 2, which needs
// no products of whole covariances [Gilmour, Thompson and Cullis 1995, Biometrics 51, "Average information
// REML"]. Work and memory grow with the number of rows: windows of a drive share three numbers only.
class ScatterLikelihood {
 public:
  struct Window {
    Eigen::MatrixXd response;  // rows x 7, as NoiseModel's
    Eigen::MatrixXd columns;   // rows x (1 + systematic): the residuals first
    // Variances of the rows besides those that `response` makes: of sensors and of what is left over.
    std::function<Eigen::VectorXd(const NoiseScales&)> variances;
  };
  struct Drive {
    std::vector<Window> windows;
  };
  struct Slope {
    Eigen::VectorXd by_scale;     // dl/dk
    Eigen::MatrixXd information;  // kNoiseScales x kNoiseScales
  };

  // One drive and one window in each at least.
  explicit ScatterLikelihood(std::vector<Drive> drives, std::size_t threads = 1);

  // l under these scales.
  double at(const NoiseScales& scales);
  // Under the scales that at() was last asked about.
  Slope slope() const;

 private:
  // What at() finds of a drive. With B_w = L_w L_w^T the covariance of a window's own rows and L of all of
  // them, V = B + U U^T of a drive and V^-1 = L^-T (I - E K E^T) L^-1.
  struct Solved {
    std::vector<Eigen::MatrixXd> factors;  // L_w
    Eigen::MatrixXd response;              // L^-1 times the response, in deviations; its first three are E
    Eigen::Matrix3d left;                  // K: what the drive leaves unknown of the soil's three numbers
    Eigen::MatrixXd columns;               // (I - E K E^T) L^-1 columns
  };
  // What drives add to a slope; sums of it are sums of their parts.
  struct SlopePart {
    Eigen::VectorXd by_scale;
    Eigen::MatrixXd squares;   // of V_k a, whitened by the drives' own V
    Eigen::MatrixXd products;  // systematic x scales: what the systematic columns take of them
  };
  // Adds the products of the drive's solved columns to `squares`; returns -1/2 log |V_d|.
  double solve(const Drive& drive, Solved& solved, Eigen::MatrixXd& squares) const;
  void add_slope(const Drive& drive, const Solved& solved, SlopePart& part) const;

  std::vector<Drive> drives_;
  std::vector<Solved> solved_;
  std::size_t threads_;
  NoiseScales scales_;
  // As many sums as this whatever the number of threads, so that there is one order of summing.
  std::vector<Eigen::MatrixXd> squares_;
  Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> systematic_;  // of I + A^T V^-1 A
  Eigen::VectorXd explained_;                             // the systematic columns' part in the residuals
};

}  // namespace slipway::gap
