#include "gap/diagnosis/model/block_whitening.h"

#include <Eigen/Eigenvalues>
#include <utility>

namespace slipway::gap {

void BlockWhitening::add(Eigen::MatrixXd own, const Eigen::MatrixXd& shared) {
  if (blocks_.empty()) left_ = Eigen::MatrixXd::Identity(shared.cols(), shared.cols());
  own.noalias() += shared * left_ * shared.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(own);
  Block block{spectrum.operatorInverseSqrt(), shared, {}};
  block.learned = block.inverse_root * (shared * left_);
  left_.noalias() -= block.learned.transpose() * block.learned;
  log_determinant_ += spectrum.eigenvalues().array().log().sum();
  rows_ += shared.rows();
  blocks_.push_back(std::move(block));
}

Eigen::MatrixXd BlockWhitening::whiten(const Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd white(columns.rows(), columns.cols());
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(left_.rows(), columns.cols());
  Eigen::Index row = 0;
  for (const Block& block : blocks_) {
    const Eigen::Index n = block.inverse_root.rows();
    auto part = white.middleRows(row, n);
    part.noalias() = block.inverse_root * (columns.middleRows(row, n) - block.shared * expected);
    expected.noalias() += block.learned.transpose() * part;
    row += n;
  }
  return white;
}

std::size_t BlockWhitening::bytes() const {
  Eigen::Index numbers = left_.size();
  for (const Block& block : blocks_)
    numbers += block.inverse_root.size() + block.shared.size() + block.learned.size();
  return static_cast<std::size_t>(numbers) * sizeof(double);
}

}  // namespace slipway::gap
