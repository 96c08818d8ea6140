#include "gap/diagnosis/model/smooth_difference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "core/angle.h"
#include "core/progress.h"
#include "gap/diagnosis/search/prepared_campaign.h"
#include "tests/gap/practice_drives.h"

namespace slipway::gap {
namespace {

// What drives predict, with what a difference of theirs would be made of.
struct Predicted {
  explicit Predicted(DriveCampaign drives) : campaign(std::make_unique<DriveCampaign>(std::move(drives))) {
    NoProgress progress;
    auto made = prepare_as_believed(*campaign, DiagnosisOptions{}, progress);
    if (!made) throw std::runtime_error(made.error().detail);
    prepared = std::move(*made);
    const Hypothesis hypothesis(*campaign, {});
    expected = hypothesis.predict(*prepared.model, hypothesis.neutral());
  }
  SmoothRange range() const { return smooth_range(*prepared.model, expected); }
  Eigen::MatrixXd beyond(const SmoothRange& met) const {
    return columns_beyond(*prepared.model, expected, smooth_scale(*prepared.model, expected), met);
  }
  // Largest of what lies beyond, of the windows of which this holds.
  template <class Holds>
  double most_beyond(const SmoothRange& met, const Holds& holds) const {
    const Eigen::MatrixXd columns = beyond(met);
    double most = 0.0;
    for (std::size_t w = 0; w < prepared.windows.size(); ++w) {
      if (!holds(prepared.windows[w].command) || columns.cols() == 0) continue;
      const auto count = static_cast<Eigen::Index>(prepared.windows[w].observations.size());
      most = std::max(most, columns.middleRows(static_cast<Eigen::Index>(prepared.model->offset(w)), count)
                                .cwiseAbs()
                                .maxCoeff());
    }
    return most;
  }

  std::unique_ptr<DriveCampaign> campaign;
  PreparedCampaign prepared;
  std::vector<double> expected;
};

template <class Holds>
DriveCampaign drives_where(const Holds& holds) {
  DriveCampaign campaign = some_drives(1);
  std::erase_if(campaign.drives, [&](const MeasuredDriveSeries& drive) { return !holds(drive.command); });
  for (MeasuredDriveSeries& drive : campaign.drives) drive.repeat_of.reset();
  return campaign;
}

bool turns(const sim::DriveCommand& command) {
  return command.turn_in_place;
}
bool backs(const sim::DriveCommand& command) {
  return !command.turn_in_place && command.speed_m_s < 0.0;
}

TEST(ColumnsBeyond, AreNothingForTheDrivesThatWereLearntFrom) {
  const Predicted all(some_drives(3));
  EXPECT_EQ(all.beyond(all.range()).cols(), 0);
}

// A reference of other kinds has told nothing of one, on level ground neither.
TEST(ColumnsBeyond, AreOpenForAKindOfDriveThatTheReferenceHasNoneOf) {
  const Predicted all(some_drives(1));
  const auto is_other = [](const sim::DriveCommand& command) { return !turns(command) && !backs(command); };
  for (const auto& kind : {turns, backs}) {
    const auto drives = drives_where([&](const sim::DriveCommand& command) { return !kind(command); });
    ASSERT_LT(drives.drives.size(), all.campaign->drives.size()) << "the practice drives have some";
    const SmoothRange without = Predicted(drives).range();
    EXPECT_GT(all.most_beyond(without, kind), 0.0);
    EXPECT_EQ(all.most_beyond(without, is_other), 0.0) << "the others were all met";
  }
}

TEST(ColumnsBeyond, GrowWithSpeedAndCurvatureBeyondWhatWasMet) {
  const Predicted all(some_drives(1));
  const SmoothRange met = all.range();
  const auto any = [](const sim::DriveCommand&) { return true; };
  for (const std::size_t circumstance : {std::size_t{11}, std::size_t{12}}) {
    SmoothRange narrower = met;
    const double width = met.highest[circumstance] - met.lowest[circumstance];
    ASSERT_GT(width, 0.0) << circumstance;
    narrower.highest[circumstance] -= 0.1 * width;
    const double little = all.most_beyond(narrower, any);
    EXPECT_GT(little, 0.0) << circumstance;
    narrower.highest[circumstance] -= 0.1 * width;
    EXPECT_GT(all.most_beyond(narrower, any), little) << circumstance;
  }
}

TEST(ColumnsBeyond, AreOpenForTurnsInTheOtherSense) {
  const Predicted all(some_drives(1));
  SmoothRange met = all.range();
  ASSERT_EQ(met.lowest[10], met.highest[10]) << "the practice drives turn in one sense";
  met.lowest[10] = met.highest[10] = -met.highest[10];
  EXPECT_GT(all.most_beyond(met, turns), 0.0);
  EXPECT_EQ(all.most_beyond(met, [](const sim::DriveCommand& command) { return !turns(command); }), 0.0);
}

}  // namespace
}  // namespace slipway::gap
