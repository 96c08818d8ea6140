#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace slipway::gap {

// What explanations that rival each other say of drives that nobody has made yet, about what is re-tuned
// linear: rows are observations in independent deviations of one, those of a drive together.
struct RivalOutcomes {
  std::vector<Eigen::Index> first_row;  // of each drive; one more behind: all rows
  Eigen::MatrixXd means;                // rows x rivals
  Eigen::MatrixXd responses;            // rows x re-tuned parameters
  Eigen::MatrixXd covariance;           // of those parameters, after the drives that were made
  std::vector<double> weights;          // of the rivals, before; any sum above 0
  std::vector<std::size_t> family;      // of each rival: which of one family is at work does not matter
  double believed = 1.0;                // share of the logarithm of the evidence
  // What a rival says beside 0 may be off by this share (a deviation), in each drive by another.
  double imprecision = 0.0;

  std::size_t drives() const { return first_row.size() - 1; }
};

struct ChosenDrive {
  std::size_t drive = 0;
  double bits = 0.0;  // that it is expected to add to those of the drives chosen before it
};

// The drives, none twice, from which one is expected to learn most about the family, one after the other,
// each beside those chosen before. The information is the estimate by pairwise Bhattacharyya distances, which
// is never above the true one [Kolchinsky & Tracey 2017]. Of less than `least_bits` none is chosen.
std::vector<ChosenDrive> most_telling_drives(RivalOutcomes outcomes, std::size_t most, double least_bits);

}  // namespace slipway::gap
