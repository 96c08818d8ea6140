#include "gap/diagnosis/model/block_cholesky.h"

#include <Eigen/Cholesky>
#include <utility>

namespace slipway::gap {

void BlockCholesky::add(Eigen::MatrixXd own, const Eigen::MatrixXd& shared) {
  if (blocks_.empty()) left_ = Eigen::MatrixXd::Identity(shared.cols(), shared.cols());
  own.noalias() += shared * left_ * shared.transpose();
  Block block{own.llt().matrixL(), shared, {}};
  block.learned = block.factor.triangularView<Eigen::Lower>().solve(shared * left_);
  left_.noalias() -= block.learned.transpose() * block.learned;
  log_determinant_ += 2.0 * block.factor.diagonal().array().log().sum();
  rows_ += shared.rows();
  blocks_.push_back(std::move(block));
}

Eigen::MatrixXd BlockCholesky::solve(const Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd white(columns.rows(), columns.cols());
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(left_.rows(), columns.cols());
  Eigen::Index row = 0;
  for (const Block& block : blocks_) {
    const Eigen::Index n = block.factor.rows();
    auto part = white.middleRows(row, n);
    part = columns.middleRows(row, n);
    part.noalias() -= block.shared * expected;
    block.factor.triangularView<Eigen::Lower>().solveInPlace(part);
    expected.noalias() += block.learned.transpose() * part;
    row += n;
  }
  return white;
}

std::size_t BlockCholesky::bytes() const {
  Eigen::Index numbers = left_.size();
  for (const Block& block : blocks_)
    numbers += block.factor.size() + block.shared.size() + block.learned.size();
  return static_cast<std::size_t>(numbers) * sizeof(double);
}

}  // namespace slipway::gap
