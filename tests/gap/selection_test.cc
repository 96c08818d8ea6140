#include "gap/diagnosis/search/selection.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "gap/diagnosis/model/noise_model.h"

namespace slipway::gap {
namespace {

// Counting a group twice is having its rows twice.
TEST(GroupedEvidence, IsTheEvidenceOfTheDrivesAsOftenAsTheyCount) {
  constexpr Eigen::Index kRows = 9;
  const std::vector<std::size_t> group_of_row{0, 0, 1, 1, 1, 2, 0, 2, 1};
  const std::vector<int> times{2, 0, 1};
  Eigen::VectorXd r(kRows);
  Eigen::MatrixXd a(kRows, 2);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    r[i] = random_normal(1, static_cast<std::uint64_t>(i));
    for (Eigen::Index c = 0; c < 2; ++c)
      a(i, c) = random_normal(2 + static_cast<std::uint64_t>(c), static_cast<std::uint64_t>(i));
  }
  const GroupedEvidence evidence(r, a, group_of_row, 3);
  EXPECT_NEAR(evidence.counted(std::vector<int>{1, 1, 1}), log_marginal(r, a), 1e-10);
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < kRows; ++i)
    for (int k = 0; k < times[group_of_row[static_cast<std::size_t>(i)]]; ++k) rows.push_back(i);
  EXPECT_NEAR(evidence.counted(times),
              log_marginal(Eigen::VectorXd(r(rows)), Eigen::MatrixXd(a(rows, Eigen::all))), 1e-10);
}

}  // namespace
}  // namespace slipway::gap
