// A channel of recorded drives that is added as CONTRIBUTING says, by a row (wheel_rate_channel.cc) and an
// entry in gap/diagnosis/model/channel_catalogue.cc, is read from CSV files, compared and reported.
// CMakeLists.txt adds the entry to a copy of that file.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "api/documents/diagnosis/diagnosis_document.h"
#include "api/documents/soil/soil_estimate_document.h"
#include "api/report/diagnosis_charts.h"
#include "api/requests/soil_estimate.h"
#include "gap/diagnosis/model/channel.h"
#include "gap/diagnosis/search/prepared_campaign.h"
#include "tests/api/drive_campaign_folder.h"
#include "tests/api/made_diagnosis.h"

namespace slipway::api {
namespace {

constexpr auto kWheelRate = static_cast<gap::Channel>(7);  // behind those that ship

gap::DriveCampaign some_drives() {
  gap::DriveCampaign campaign = testing::practice_campaign();
  std::vector<gap::MeasuredDriveSeries> kept;
  for (std::size_t d = 0; d < campaign.drives.size(); d += 5) kept.push_back(campaign.drives[d]);
  for (gap::MeasuredDriveSeries& drive : kept) drive.repeat_of.reset();
  campaign.drives = std::move(kept);
  return campaign;
}

using NewChannel = testing::DriveCampaignFolder;

TEST_F(NewChannel, IsReadFromItsColumnWithItsRange) {
  write("a.csv", "t_s,x_m,y_m,z_m,lf_encoder_deg_s\n0,1,2,0.5,-24\n2,1.1,2,0.5,-26\n");
  const auto campaign = load();
  ASSERT_TRUE(campaign) << campaign.error().detail;
  EXPECT_NEAR(campaign->drives[0].samples[0].wheels[0].rate_rad_s, -24.0 / 57.29578, 1e-6);
  expect_csv_fault("t_s,lf_encoder_deg_s\n0,1\n1,1e9\n", "/3/lf_encoder_deg_s", "must be in [-10000, 10000]");
}

TEST(NewChannelOfADiagnosis, IsObservedInWindowsAndPredicted) {
  const gap::DriveCampaign campaign = some_drives();
  const std::vector<gap::DriveWindow> windows = gap::cut_windows(campaign);
  const gap::WindowModel model(campaign, windows);
  const gap::Hypothesis nominal(campaign, {});
  const std::vector<double> predicted = nominal.predict(model, nominal.neutral(), 2);
  std::size_t row = 0, count = 0;
  for (const gap::DriveWindow& window : windows)
    for (const gap::Observation& o : window.observations) {
      const double value = predicted[row++];
      if (o.channel != kWheelRate) continue;
      ++count;
      EXPECT_GE(o.wheel, 0);
      if (std::isfinite(value)) {
        EXPECT_NEAR(value, o.value, 0.02) << "the motors keep their rates";
      }
    }
  EXPECT_GE(count, 6 * windows.size());
}

TEST(NewChannelOfADiagnosis, IsFittedWithItsNoise) {
  const gap::DriveCampaign campaign = some_drives();
  NoProgress progress;
  const auto prepared = gap::prepare(campaign, {}, progress);
  ASSERT_TRUE(prepared);
  bool weighed = false;
  for (std::size_t w = 0; w < prepared->windows.size(); ++w)
    for (std::size_t i = 0; i < prepared->windows[w].observations.size(); ++i)
      if (prepared->windows[w].observations[i].channel == kWheelRate)
        weighed =
            weighed ||
            prepared->noise->deviation()[static_cast<Eigen::Index>(prepared->model->offset(w) + i)] >= 2e-3;
  EXPECT_TRUE(weighed);
}

TEST(NewChannelOfADiagnosis, IsAChannelThatARequestCanChoose) {
  SoilEstimateRequest request;
  request.campaign = "p05";
  EXPECT_TRUE(choose_channels({"wheel_rate"}, request).empty());
  EXPECT_EQ(request.looked_at, (std::vector<bool>{false, false, false, false, false, false, false, true}));
  const auto faults = choose_channels({"wheel_rates"}, request);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_NE(faults[0].message.find("did you mean \"wheel_rate\""), std::string::npos) << faults[0].message;
}

TEST(NewChannelOfADiagnosis, IsInDocumentsAndChartsWithItsUnit) {
  const gap::DriveCampaign campaign = testing::practice_campaign();
  gap::Diagnosis diagnosis = testing::full_diagnosis(campaign);
  diagnosis.channels = {{kWheelRate, "lf", 0.01, 0.005, 0.0, 0.5}};
  diagnosis.held_out.front().channel = kWheelRate;
  const std::string document = json::diagnosis_document(campaign, diagnosis);
  EXPECT_NE(document.find("\"channel\":\"wheel_rate\""), std::string::npos) << document.substr(0, 2000);
  std::string charts;
  for (const NamedChart& chart : draw_diagnosis(campaign, diagnosis)) charts += chart.svg;
  EXPECT_NE(charts.find("wheel rate, deg/s"), std::string::npos);
}

}  // namespace
}  // namespace slipway::api
