// The practice campaigns that ship, against their answers.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>
#include <vector>

#include "api/files/campaign/drive_campaign_source.h"
#include "api/files/catalogue.h"
#include "gap/diagnosis/diagnosis.h"
#include "tests/full_size.h"

namespace slipway::gap {
namespace {

// At full size of all drives, otherwise of each so many.
Diagnosis diagnosis_of(const char* name, std::size_t every = 1, std::vector<std::string> withheld = {}) {
  const std::filesystem::path data = SLIPWAY_DATA_FOLDER;
  auto campaign = api::load_drive_campaign(data / "gap-practice" / name, api::Catalogue{});
  EXPECT_TRUE(campaign) << name;
  if (!full_size()) {
    std::vector<MeasuredDriveSeries> some;
    for (std::size_t d = 0; d < campaign->drives.size(); d += every) some.push_back(campaign->drives[d]);
    campaign->drives = std::move(some);
  }
  DiagnosisOptions options;
  options.search.withheld = std::move(withheld);
  NoProgress progress;
  auto diagnosis = diagnose(*campaign, options, progress);
  EXPECT_TRUE(diagnosis) << name;
  double sum = 0.0, chosen = 0.0;
  for (const ComparedSet& set : diagnosis->candidates) {
    sum += set.probability;
    chosen += set.chosen_share;
  }
  EXPECT_NEAR(sum, 1.0, 1e-9) << name;
  EXPECT_NEAR(chosen, 1.0, 1e-9) << name;
  return std::move(*diagnosis);
}

std::vector<std::string> names(const Diagnosis& diagnosis) {
  std::vector<std::string> all;
  for (const FoundEffect& effect : diagnosis.effects) all.push_back(effect.name);
  return all;
}

const FoundParameter& parameter(const Diagnosis& diagnosis, const std::string& name) {
  for (const FoundEffect& effect : diagnosis.effects)
    for (const FoundParameter& p : effect.parameters)
      if (p.name == name) return p;
  throw std::out_of_range(name);
}

TEST(PracticeCampaigns, NothingIsFoundWhereNothingIsMissing) {
  const Diagnosis diagnosis = diagnosis_of("p01", 4);
  EXPECT_EQ(diagnosis.verdict, Verdict::kNoGap) << diagnosis.reason;
  EXPECT_TRUE(diagnosis.effects.empty());
  EXPECT_FALSE(diagnosis.least_detectable.empty());
}

TEST(PracticeCampaigns, SlipSinkageIsFoundWithItsSize) {
  const Diagnosis diagnosis = diagnosis_of("p03");
  EXPECT_EQ(diagnosis.verdict, Verdict::kEffects) << diagnosis.reason;
  ASSERT_EQ(names(diagnosis), std::vector<std::string>{"slip_sinkage"});
  const Interval& n1 = parameter(diagnosis, "n1").value;
  EXPECT_LT(n1.low, 0.35);
  EXPECT_GT(n1.high, 0.35);
}

TEST(PracticeCampaigns, MotorTemperatureIsFoundAndCanBeWithheld) {
  const Diagnosis found = diagnosis_of("p05");
  EXPECT_EQ(found.verdict, Verdict::kEffects) << found.reason;
  ASSERT_EQ(names(found), std::vector<std::string>{"motor_temperature"});
  EXPECT_NEAR(parameter(found, "friction_per_k").value.value, 0.02, 0.002);
  ASSERT_TRUE(found.model) << "the correction improves drives that were held out";
  for (const ChannelClosure& channel : found.gap) {
    if (channel.channel == Channel::kCurrent) {
      EXPECT_LT(channel.with_effects.high, 0.7 * channel.retuned.low);
    }
  }
  EXPECT_GT(found.candidates.front().chosen_share, 0.9) << "of resampled drives";
  ASSERT_EQ(found.extrapolations.size(), 2U) << "slope and temperature differ, speed does not";
  for (const Extrapolation& e : found.extrapolations)
    EXPECT_GT(e.log_density_gain, 2.0 * e.error) << e.variable;
  const Diagnosis without = diagnosis_of("p05", 1, {"motor_temperature"});
  const std::vector<std::string> named = names(without);
  EXPECT_EQ(std::count(named.begin(), named.end(), "motor_temperature"), 0);
  EXPECT_EQ(without.verdict, Verdict::kUnknown) << without.reason;
}

TEST(PracticeCampaigns, BothOfAPairAreFound) {
  const Diagnosis diagnosis = diagnosis_of("p07", 2);
  EXPECT_EQ(diagnosis.verdict, Verdict::kEffects) << diagnosis.reason;
  std::vector<std::string> named = names(diagnosis);
  std::sort(named.begin(), named.end());
  ASSERT_EQ(named, (std::vector<std::string>{"grousers", "wheel_radius"}));
  EXPECT_NEAR(parameter(diagnosis, "scale").value.value, 0.03, 0.003);
}

TEST(PracticeCampaigns, APullThatNoEffectKnowsIsUnknown) {
  const Diagnosis diagnosis = diagnosis_of("p08", 4);
  EXPECT_EQ(diagnosis.verdict, Verdict::kUnknown) << diagnosis.reason;
  EXPECT_TRUE(diagnosis.effects.empty()) << "a small bulldozing would be the pull's shadow";
  ASSERT_FALSE(diagnosis.residual.empty());
  EXPECT_EQ(diagnosis.residual.front().entry, "tangential_force");
  std::set<std::pair<std::string, std::string>> listed;
  for (const ResidualShape& shape : diagnosis.residual)
    EXPECT_TRUE(listed.emplace(shape.entry, shape.variable).second)
        << shape.entry << " by " << shape.variable << " is listed twice";
  EXPECT_EQ(diagnosis.residual.front().variable, "direction");
  EXPECT_EQ(diagnosis.residual.front().form, "force_on_body");
  EXPECT_NE(diagnosis.residual.front().words.find("against the travel, at the body"), std::string::npos)
      << diagnosis.residual.front().words;
  EXPECT_NEAR(diagnosis.residual.front().parameters.front().value.value, -25.0, 5.0);
}

}  // namespace
}  // namespace slipway::gap
