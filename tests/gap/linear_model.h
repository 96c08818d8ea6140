#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/random.h"
#include "gap/diagnosis/search/posterior_mode.h"

namespace slipway::gap::testing {

// A parameter of an effect with its prior around 0.
inline Parameter parameter(double std, double lowest = -1e9, double highest = 1e9) {
  Parameter p;
  p.name = p.effect = "effect";
  p.std = std;
  p.lowest = lowest;
  p.highest = highest;
  return p;
}

// y = A x + noise of known deviations: what everything has a closed form for.
class LinearModel : public FittedModel {
 public:
  LinearModel(Eigen::MatrixXd a, Eigen::VectorXd y, Eigen::VectorXd deviation,
              std::vector<Parameter> parameters)
      : a_(std::move(a)),
        y_(std::move(y)),
        deviation_(std::move(deviation)),
        parameters_(std::move(parameters)) {}

  std::span<const Parameter> parameters() const override { return parameters_; }
  const Eigen::VectorXd& measured() const override { return y_; }
  std::vector<double> predict(std::span<const double> x) const override {
    const Eigen::VectorXd f =
        a_ * Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
    return {f.begin(), f.end()};
  }
  Eigen::MatrixXd scaled_jacobian(std::span<const double>, std::span<const double>) const override {
    Eigen::MatrixXd scaled = a_;
    for (std::size_t p = 0; p < parameters_.size(); ++p)
      scaled.col(static_cast<Eigen::Index>(p)) *= parameters_[p].std;
    return scaled;
  }
  Eigen::MatrixXd whiten(const Eigen::MatrixXd& columns) const override {
    return deviation_.cwiseInverse().asDiagonal() * columns;
  }
  const Eigen::VectorXd& deviation() const override { return deviation_; }
  bool cancelled() const override { return false; }

 private:
  Eigen::MatrixXd a_;
  Eigen::VectorXd y_, deviation_;
  std::vector<Parameter> parameters_;
};

inline Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  Eigen::MatrixXd m(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index j = 0; j < columns; ++j)
      m(i, j) = random_normal(seed + static_cast<std::uint64_t>(j), static_cast<std::uint64_t>(i));
  return m;
}

// Until nothing changes any more.
inline FitOptions to_the_end() {
  FitOptions options;
  options.huber = 1e9;
  options.min_fall = 1e-14;
  options.tolerance = 1e-12;
  options.max_iterations = 200;
  return options;
}

}  // namespace slipway::gap::testing
