#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace slipway::gap {

// Whitens what scatters by a covariance whose blocks share a few causes,
//
//   V = blockdiag(B_1, ..., B_m) + U U^T,   W V W^T = 1.
//
// The blocks' innovations are found one after the other, as Kalman's filter finds them: what the blocks
// before say of the shared causes has the covariance P, so that block k scatters by S_k = B_k + U_k P U_k^T
// around what they let expect of it. An innovation is divided by the symmetric root of S_k [Kessy, Lewin and
// Strimmer 2018, "Optimal whitening and decorrelation"]: each whitened row is the one nearest to its own row,
// whatever the order of rows in a block. Memory and work grow with the number of blocks and not with its
// square.
class BlockWhitening {
 public:
  // The next block: its own covariance, and its rows of U. Every block has as many columns of U.
  void add(Eigen::MatrixXd own, const Eigen::MatrixXd& shared);

  // W columns; as many rows as all blocks have together.
  Eigen::MatrixXd whiten(const Eigen::MatrixXd& columns) const;
  // log |V|
  double log_determinant() const { return log_determinant_; }
  Eigen::Index rows() const { return rows_; }
  // Of numbers that are held, for those who ask what a longer drive costs.
  std::size_t bytes() const;

 private:
  struct Block {
    Eigen::MatrixXd inverse_root;  // S_k^-1/2
    Eigen::MatrixXd shared;        // U_k
    Eigen::MatrixXd learned;       // S_k^-1/2 U_k P: what its whitened rows say of the shared causes
  };
  std::vector<Block> blocks_;
  Eigen::MatrixXd left_;  // P
  Eigen::Index rows_ = 0;
  double log_determinant_ = 0.0;
};

}  // namespace slipway::gap
