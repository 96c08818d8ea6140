#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace slipway::gap {

// The Cholesky factor L of a covariance whose blocks share a few causes,
//
//   L L^T = blockdiag(B_1, ..., B_m) + U U^T,
//
// found block after block as Kalman's filter finds its innovations: what the blocks before say of the shared
// causes has the covariance P, so that block k scatters by B_k + U_k P U_k^T. The factor is the dense one,
// number by number but for rounding; its memory and its work grow with the number of blocks and not with its
// square.
class BlockCholesky {
 public:
  // The next block: its own covariance, and its rows of U. Every block has as many columns of U.
  void add(Eigen::MatrixXd own, const Eigen::MatrixXd& shared);

  // L^-1 columns; as many rows as all blocks have together.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& columns) const;
  // log |L L^T|
  double log_determinant() const { return log_determinant_; }
  Eigen::Index rows() const { return rows_; }
  // Of numbers that are held, for those who ask what a longer drive costs.
  std::size_t bytes() const;

 private:
  struct Block {
    Eigen::MatrixXd factor;   // of what the block scatters by, given those before
    Eigen::MatrixXd shared;   // U_k
    Eigen::MatrixXd learned;  // factor^-1 U_k P: what its whitened rows say of the shared causes
  };
  std::vector<Block> blocks_;
  Eigen::MatrixXd left_;  // P
  Eigen::Index rows_ = 0;
  double log_determinant_ = 0.0;
};

}  // namespace slipway::gap
