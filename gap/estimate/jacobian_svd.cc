#include "gap/estimate/jacobian_svd.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <cmath>

namespace slipway::gap {
namespace {

// "0.71 k_c - 0.71 k_phi", the first large component positive, small ones left out.
std::string words_of(const Eigen::VectorXd& direction, const std::vector<std::string>& names) {
  std::string words;
  for (Eigen::Index k = 0; k < direction.size(); ++k) {
    if (std::abs(direction[k]) < 0.05) continue;
    const bool negative = direction[k] < 0.0;
    words += words.empty() ? (negative ? "-" : "") : (negative ? " - " : " + ");
    words += fmt::format("{:.2f} {}", std::abs(direction[k]), names[static_cast<std::size_t>(k)]);
  }
  return words;
}

}  // namespace

JacobianSvd covariance_by_svd(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& scale,
                              const std::vector<std::string>& names, double rank_tolerance) {
  const Eigen::Index n = jacobian.cols();
  // More columns than rows leave directions without a singular value; rows of zeros give them one.
  Eigen::MatrixXd scaled = Eigen::MatrixXd::Zero(std::max(jacobian.rows(), n), n);
  scaled.topRows(jacobian.rows()) = jacobian * scale.asDiagonal();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& values = svd.singularValues();
  JacobianSvd result;
  result.covariance = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::VectorXd v = svd.matrixV().col(k);
    if (values[0] > 0.0 && values[k] > rank_tolerance * values[0]) {
      v = v.cwiseProduct(scale);
      result.covariance += v * v.transpose() / (values[k] * values[k]);
    } else {
      Eigen::Index largest = 0;
      v.cwiseAbs().maxCoeff(&largest);
      if (v[largest] < 0.0) v = -v;
      result.undetermined.push_back({v, values[0] > 0.0 ? values[k] / values[0] : 0.0, words_of(v, names)});
    }
  }
  return result;
}

}  // namespace slipway::gap
