#include <gtest/gtest.h>

#include <cstdint>

#include "core/random.h"
#include "gap/diagnosis/diagnosis.h"
#include "tests/gap/practice_drives.h"

namespace slipway::gap {
namespace {

// The drives made again, command for command and place for place, with currents that read so much more.
DriveCampaign made_again(DriveCampaign campaign, double more_a) {
  constexpr double kNoise_a = 0.002;
  std::uint64_t count = 0;
  for (MeasuredDriveSeries& drive : campaign.drives) {
    drive.id += " again";
    for (DriveSample& sample : drive.samples)
      for (WheelReading& wheel : sample.wheels)
        wheel.current_a += more_a + kNoise_a * (random_uniform(7, count++) - 0.5);
  }
  campaign.fingerprint += " again";
  return campaign;
}

// What a reference leaves open is wider than what it and its repetition differ by: a constant on all currents
// went unseen by the explanations, while the drives, followed one after the other, showed it.
TEST(ADiagnosis, DoesNotSayThatNothingIsMissingWhereRepeatedDrivesShowAChange) {
  const DriveCampaign healthy = some_drives(8);
  NoProgress progress;
  DiagnosisOptions options;
  options.search.max_refitted = 3;
  options.search.max_paired = 1;
  for (const double more_a : {0.0, 0.03}) {
    const auto diagnosis = diagnose_since(healthy, made_again(healthy, more_a), options, progress);
    ASSERT_TRUE(diagnosis);
    EXPECT_EQ(finds_nothing_missing(diagnosis->verdict), more_a == 0.0) << more_a << diagnosis->reason;
  }
}

}  // namespace
}  // namespace slipway::gap
