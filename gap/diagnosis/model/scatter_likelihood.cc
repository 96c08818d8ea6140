#include "gap/diagnosis/model/scatter_likelihood.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel_for.h"

namespace slipway::gap {
namespace {

constexpr std::size_t kSums = 8;
constexpr int kSoil = 3, kResponses = 7;
// Positions in NoiseScales.
constexpr int kLean = 4, kShift = 5, kFirstLeftOver = 6;

Eigen::Vector<double, kResponses> deviations_of(const NoiseScales& s) {
  return {s.stiffness, s.friction, s.shear_modulus, s.lean_rad, s.lean_rad, s.load_shift_m, s.load_shift_m};
}

// dv/d log(scale k) of a window's own variances.
Eigen::VectorXd variance_slope(const ScatterLikelihood::Window& window, const NoiseScales& scales, int k) {
  constexpr double kStep = 1e-4;
  const auto at = [&](double step) {
    NoiseScales moved = scales;
    *numbers_of(moved)[static_cast<std::size_t>(k)] *= std::exp(step);
    return window.variances(moved);
  };
  return (at(kStep) - at(-kStep)) / (2.0 * kStep);
}

Eigen::Index rows_of(const ScatterLikelihood::Drive& drive) {
  Eigen::Index rows = 0;
  for (const ScatterLikelihood::Window& window : drive.windows) rows += window.columns.rows();
  return rows;
}

}  // namespace

ScatterLikelihood::ScatterLikelihood(std::vector<Drive> drives, std::size_t threads)
    : drives_(std::move(drives)),
      solved_(drives_.size()),
      threads_(threads),
      squares_(std::min(kSums, drives_.size())) {}

double ScatterLikelihood::at(const NoiseScales& scales) {
  scales_ = scales;
  const Eigen::Index all = drives_.front().windows.front().columns.cols();
  std::vector<double> determinants(squares_.size(), 0.0);
  parallel_for(squares_.size(), threads_, [&](std::size_t part) {
    squares_[part].setZero(all, all);
    for (std::size_t d = part; d < drives_.size(); d += squares_.size())
      determinants[part] += solve(drives_[d], solved_[d], squares_[part]);
  });
  double likelihood = determinants.front();
  Eigen::MatrixXd sum = squares_.front();
  for (std::size_t part = 1; part < squares_.size(); ++part) {
    sum += squares_[part];
    likelihood += determinants[part];
  }
  sum.diagonal().tail(all - 1).array() += 1.0;
  systematic_.compute(sum.bottomRightCorner(all - 1, all - 1));
  const Eigen::VectorXd products = sum.col(0).tail(all - 1);
  explained_ = systematic_.solve(products);
  return likelihood - 0.5 * (sum(0, 0) - products.dot(explained_)) -
         systematic_.matrixLLT().diagonal().array().log().sum();
}

double ScatterLikelihood::solve(const Drive& drive, Solved& solved, Eigen::MatrixXd& squares) const {
  const Eigen::Vector<double, kResponses> deviations = deviations_of(scales_);
  const double within = scales_.within_drives * scales_.within_drives;
  const Eigen::Index rows = rows_of(drive);
  solved.factors.resize(drive.windows.size());
  solved.response.resize(rows, kResponses);
  solved.columns.resize(rows, squares.cols());
  double determinant = 0.0;
  Eigen::Index row = 0;
  for (std::size_t w = 0; w < drive.windows.size(); ++w) {
    const Window& window = drive.windows[w];
    const Eigen::Index n = window.columns.rows();
    auto response = solved.response.middleRows(row, n);
    auto columns = solved.columns.middleRows(row, n);
    response = window.response * deviations.asDiagonal();
    columns = window.columns;
    Eigen::MatrixXd own = within * response.leftCols(kSoil) * response.leftCols(kSoil).transpose();
    own += response.rightCols(kResponses - kSoil) * response.rightCols(kResponses - kSoil).transpose();
    own.diagonal() += window.variances(scales_);
    const Eigen::MatrixXd& factor = solved.factors[w] = own.llt().matrixL();
    factor.triangularView<Eigen::Lower>().solveInPlace(response);
    factor.triangularView<Eigen::Lower>().solveInPlace(columns);
    determinant += factor.diagonal().array().log().sum();
    row += n;
  }
  squares.selfadjointView<Eigen::Lower>().rankUpdate(solved.columns.transpose());
  const auto shared = solved.response.leftCols(kSoil);
  const Eigen::LLT<Eigen::Matrix3d> known(Eigen::Matrix3d::Identity() + shared.transpose() * shared);
  solved.left = known.solve(Eigen::Matrix3d::Identity());
  const Eigen::MatrixXd of_soil = shared.transpose() * solved.columns;
  const Eigen::MatrixXd whitened = known.matrixL().solve(of_soil);
  squares.selfadjointView<Eigen::Lower>().rankUpdate(whitened.transpose(), -1.0);
  solved.columns.noalias() -= shared * (solved.left * of_soil);
  return -determinant - known.matrixLLT().diagonal().array().log().sum();
}

ScatterLikelihood::Slope ScatterLikelihood::slope() const {
  std::vector<SlopePart> parts(squares_.size(), {Eigen::VectorXd::Zero(kNoiseScales),
                                                 Eigen::MatrixXd::Zero(kNoiseScales, kNoiseScales),
                                                 Eigen::MatrixXd::Zero(systematic_.rows(), kNoiseScales)});
  parallel_for(parts.size(), threads_, [&](std::size_t part) {
    for (std::size_t d = part; d < drives_.size(); d += parts.size())
      add_slope(drives_[d], solved_[d], parts[part]);
  });
  for (std::size_t part = 1; part < parts.size(); ++part) {
    parts.front().by_scale += parts[part].by_scale;
    parts.front().squares += parts[part].squares;
    parts.front().products += parts[part].products;
  }
  const SlopePart& sum = parts.front();
  return {sum.by_scale, 0.5 * (sum.squares - sum.products.transpose() * sum.products)};
}

void ScatterLikelihood::add_slope(const Drive& drive, const Solved& solved, SlopePart& part) const {
  const double within = scales_.within_drives * scales_.within_drives;
  const Eigen::Index rows = solved.response.rows(), systematic = systematic_.rows();
  // C^-1 = L^-T (I - E K E^T - Z Z^T) L^-1; this is Z^T.
  const Eigen::MatrixXd taken = systematic_.matrixL().solve(solved.columns.rightCols(systematic).transpose());
  const Eigen::VectorXd white = solved.columns.col(0) - solved.columns.rightCols(systematic) * explained_;
  const auto shared = solved.response.leftCols(kSoil);
  const Eigen::Vector3d of_drive = shared.transpose() * white;
  Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(rows, kNoiseScales);  // L^-1 V_k a

  const Eigen::Vector3d expected = (Eigen::Matrix3d::Identity() - solved.left).diagonal() -
                                   (taken * shared).colwise().squaredNorm().transpose();
  part.by_scale.head(kSoil) += of_drive.cwiseAbs2() - expected;
  Eigen::Index row = 0;
  for (std::size_t w = 0; w < drive.windows.size(); ++w) {
    const Window& window = drive.windows[w];
    const Eigen::Index n = window.columns.rows();
    const auto factor = solved.factors[w].triangularView<Eigen::Lower>();
    const auto response = solved.response.middleRows(row, n);
    const auto soil = response.leftCols(kSoil);
    const Eigen::VectorXd own = white.segment(row, n);
    auto out = moved.middleRows(row, n);
    // I - E K E^T - Z Z^T of this window's rows.
    Eigen::MatrixXd inner = Eigen::MatrixXd::Identity(n, n) - soil * solved.left * soil.transpose();
    inner.noalias() -= taken.middleCols(row, n).transpose() * taken.middleCols(row, n);
    const Eigen::VectorXd along = response.transpose() * own;
    const Eigen::VectorXd excess = along.cwiseAbs2() - (response.transpose() * inner * response).diagonal();

    part.by_scale.head(kSoil) += within * excess.head(kSoil);
    part.by_scale[kWithinScale] += within * excess.head(kSoil).sum();
    part.by_scale[kLean] += excess.segment(3, 2).sum();
    part.by_scale[kShift] += excess.segment(5, 2).sum();
    out.leftCols(kSoil) = 2.0 * soil * (of_drive + within * along.head(kSoil)).asDiagonal();
    out.col(kWithinScale) = 2.0 * within * soil * along.head(kSoil);
    out.col(kLean) = 2.0 * response.middleCols(3, 2) * along.segment(3, 2);
    out.col(kShift) = 2.0 * response.middleCols(5, 2) * along.segment(5, 2);

    const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(n, n));
    const Eigen::VectorXd a = inverse.transpose() * own;
    const Eigen::VectorXd over =
        a.cwiseAbs2() - inverse.cwiseProduct(inner * inverse).colwise().sum().transpose();
    for (int k = kFirstLeftOver; k < kNoiseScales; ++k) {
      const Eigen::VectorXd slope = variance_slope(window, scales_, k);
      part.by_scale[k] += 0.5 * slope.dot(over);
      out.col(k) = inverse * slope.cwiseProduct(a);
    }
    row += n;
  }
  const Eigen::MatrixXd of_soil = shared.transpose() * moved;
  part.squares += moved.transpose() * moved - of_soil.transpose() * solved.left * of_soil;
  part.products += taken * moved;
}

}  // namespace slipway::gap
