#include "gap/diagnosis/model/difference_columns.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/progress.h"
#include "gap/diagnosis/search/prepared_campaign.h"
#include "tests/gap/practice_drives.h"

namespace slipway::gap {
namespace {

TEST(DifferenceColumns, HaveWhatTracksChangeBesideSmoothFunctions) {
  const DriveCampaign campaign = some_drives(6);
  NoProgress progress;
  const auto prepared = prepare(campaign, DiagnosisOptions{}, progress);
  ASSERT_TRUE(prepared) << prepared.error().detail;
  const WindowModel& model = *prepared->model;
  const Hypothesis hypothesis(campaign, {});
  const std::vector<double> x = hypothesis.neutral();
  const std::vector<double> expected = hypothesis.predict(model, x);
  const SmoothScale scale = smooth_scale(model, expected);
  const Eigen::MatrixXd columns = difference_columns(model, x, expected, scale, 1);
  const std::vector<std::size_t> groups = difference_groups(*campaign.rover);

  const Eigen::MatrixXd smooth = smooth_columns(model, expected, scale);
  ASSERT_EQ(columns.cols(), smooth.cols() + 2 * static_cast<Eigen::Index>(channel_count()));
  ASSERT_EQ(groups.size(), static_cast<std::size_t>(columns.cols()));
  EXPECT_EQ(columns.leftCols(smooth.cols()), smooth);
  EXPECT_EQ(groups[groups.size() - 2], groups.back()) << "a channel's are of one size";
  EXPECT_EQ(std::count(groups.begin(), groups.end(), groups.back()), 2);

  const auto slip = smooth.cols() + 2 * static_cast<Eigen::Index>(Channel::kSlip);
  const Eigen::VectorXd usual = columns.col(slip), large = columns.col(slip + 1);
  EXPECT_TRUE(columns.allFinite());
  EXPECT_GT(usual.norm(), 0.0);
  EXPECT_GT(large.norm(), 1.5 * usual.norm());
  for (std::size_t w = 0; w < model.windows().size(); ++w) {
    if (!model.windows()[w].command.turn_in_place) continue;
    const auto count = static_cast<Eigen::Index>(model.windows()[w].observations.size());
    EXPECT_TRUE(large.segment(static_cast<Eigen::Index>(model.offset(w)), count).isZero(0.0))
        << "no wheel follows another";
  }
}

}  // namespace
}  // namespace slipway::gap
