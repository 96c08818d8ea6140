// An effect that is added as CONTRIBUTING says, by a file pair (extra_mass.h, extra_mass.cc) and a row in
// sim/effects/effect_rows.cc, acts from the API down. CMakeLists.txt adds the row to a copy of that file.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "api/documents/catalogue_documents.h"
#include "api/documents/diagnosis/diagnosis_request.h"
#include "api/documents/prediction_request.h"
#include "api/service_drives.h"
#include "gap/diagnosis/model/hypothesis.h"
#include "gap/diagnosis/model/window_model.h"
#include "research/benchmark/hidden_effect.h"
#include "research/benchmark/sealed_campaigns.h"
#include "sim/effects/effect_catalogue.h"
#include "tests/api/made_diagnosis.h"
#include "tests/api/small_world.h"

namespace slipway::api {
namespace {

const std::string kName = "extra_mass";

std::string request_with(const std::string& effects) {
  std::string request = testing::example("prediction_path.json");
  return request.insert(request.rfind('}'), effects);
}

double energy_j(const std::string& request) {
  const auto reading = json::read_prediction_request(request);
  EXPECT_TRUE(reading && reading->faults.empty());
  NoProgress progress;
  const auto answer = run_prediction(testing::small_world(), reading->request, progress);
  EXPECT_TRUE(answer) << (answer ? "" : answer.error().detail);
  return answer->prediction.energy_j;
}

TEST(NewEffect, IsInTheCatalogueThatTheServiceGives) {
  const std::string document = json::write_effects();
  EXPECT_NE(document.find("extra_mass"), std::string::npos);
  EXPECT_NE(document.find("mass that the rover carries"), std::string::npos);
}

TEST(NewEffect, ChangesThePredictionOfARequestThatSwitchesItOn) {
  const double without = energy_j(request_with(""));
  const double with =
      energy_j(request_with(R"(, "effects": [{"name": "extra_mass", "parameters": {"mass_kg": 60}}])"));
  EXPECT_GT(with, 1.1 * without);
}

TEST(NewEffect, IsRefusedBeyondItsRange) {
  const auto request = read_prediction(
      testing::small_world(),
      request_with(R"(, "effects": [{"name": "extra_mass", "parameters": {"mass_kg": 900}}])"));
  ASSERT_FALSE(request);
  ASSERT_EQ(request.error().faults.size(), 1U);
  EXPECT_EQ(request.error().faults[0].pointer, "/effects/0/parameters/mass_kg");
}

TEST(NewEffect, IsAHypothesisOfTheDiagnosisWithADerivativeAtNeutral) {
  gap::DriveCampaign campaign = testing::practice_campaign();
  campaign.drives.resize(2);
  const auto variants = gap::effect_variants(*campaign.rover, {});
  const auto variant =
      std::find_if(variants.begin(), variants.end(), [](const auto& v) { return v.effect == kName; });
  ASSERT_NE(variant, variants.end());
  const gap::Hypothesis hypothesis(campaign, {*variant});
  const gap::Parameter& mass = hypothesis.parameters().back();
  EXPECT_EQ(mass.name, "extra_mass.mass_kg");
  EXPECT_EQ(mass.neutral, 0.0);
  EXPECT_EQ(mass.std, 20.0) << "as far as the initial value is from the neutral one";
  EXPECT_EQ(mass.highest, 200.0);

  const std::vector<gap::DriveWindow> windows = gap::cut_windows(campaign);
  const gap::WindowModel model(campaign, windows);
  const Eigen::MatrixXd jacobian = hypothesis.scaled_jacobian(model, hypothesis.neutral(), 1);
  std::size_t row = 0;
  for (const gap::DriveWindow& window : windows)
    for (const gap::Observation& o : window.observations) {
      const double by_mass = jacobian(static_cast<Eigen::Index>(row++), jacobian.cols() - 1);
      if (o.channel == gap::Channel::kCurrent) {
        EXPECT_GT(by_mass, 1e-3) << "a heavier rover draws more";
      }
    }
}

TEST(NewEffect, CanBeWithheldFromADiagnosisByItsName) {
  const auto reading = json::read_diagnosis_request(R"({"campaign": "p05", "without": ["extra_mass"]})");
  ASSERT_TRUE(reading);
  EXPECT_TRUE(reading->faults.empty());
  EXPECT_EQ(reading->request.without, std::vector<std::string>{kName});
}

TEST(NewEffect, IsHiddenByTheBenchmark) {
  const auto hidden = campaign::hidden_effects();
  EXPECT_NE(std::find(hidden.begin(), hidden.end(), kName), hidden.end());
  const auto rover = testing::practice_campaign().rover;
  int alone = 0;
  for (const campaign::SealedCampaign& sealed : campaign::sealed_campaigns("each", 3, rover))
    if (sealed.hidden.size() == 1 && sealed.hidden[0].name == kName) {
      ++alone;
      EXPECT_EQ(sealed.hidden[0].parameters.at("mass_kg"), 20.0 * sealed.size);
      EXPECT_EQ(sealed.driven.effects.size(), 1U);
    }
  EXPECT_EQ(alone, 1);
}

}  // namespace
}  // namespace slipway::api
