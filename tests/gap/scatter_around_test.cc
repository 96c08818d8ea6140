// What soils' scatter does to drives, around the nominal rover and around one whose wheel drags.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gap/diagnosis/search/discrepancy_term.h"
#include "gap/diagnosis/search/explanation.h"
#include "gap/diagnosis/search/prepared_campaign.h"
#include "tests/gap/practice_drives.h"

namespace slipway::gap {
namespace {

// A wheel that turns at two fifths of its rate, not fitted to anything.
FittedExplanation slow_wheel(const DriveCampaign& campaign, const PreparedCampaign& prepared,
                             const DiagnosisOptions& options) {
  const std::vector<EffectVariant> all = effect_variants(*campaign.rover, {});
  const auto drags = std::find_if(all.begin(), all.end(),
                                  [](const EffectVariant& v) { return v.effect == "dragging_wheel"; });
  const Hypothesis hypothesis(campaign, {*drags});
  std::vector<double> x = hypothesis.neutral();
  for (std::size_t p = 0; p < x.size(); ++p)
    if (hypothesis.parameters()[p].name == "dragging_wheel.rate_share") x[p] = 0.4;
  FitOptions not_moved = options.fit;
  not_moved.max_iterations = 0;
  return fit_explanation(hypothesis, *prepared.model, *prepared.noise, x, not_moved, 1);
}

TEST(ScatterAround, AFitIsThatOfItsOwnModelAndNotOfTheNominalRover) {
  const DriveCampaign campaign = some_drives(6);
  const DiagnosisOptions options;
  NoProgress progress;
  const auto prepared = prepare_as_believed(campaign, options, progress);
  ASSERT_TRUE(prepared);
  NoiseModel& noise = *prepared->noise;
  const Eigen::VectorXd nominal = noise.deviation();
  const FittedExplanation slow = slow_wheel(campaign, *prepared, options);
  scatter_around(slow, *prepared->model, noise);
  noise.set(noise.scales());

  const Eigen::VectorXd shown = measured(*prepared->model) - slow.residuals;
  const NoiseModel direct(
      *prepared->model,
      scatter_response(slow.hypothesis, slow.jacobian,
                       lever_responses(campaign, *prepared->model, Hypothesis(campaign, {}).neutral(),
                                       options.discrepancy, 1)),
      {shown.begin(), shown.end()}, noise.used());
  double farthest = 0.0;
  for (Eigen::Index row = 0; row < nominal.size(); ++row) {
    const bool answered = slow.jacobian.row(row).head(3).norm() > 0.0;
    if (nominal[row] == 0.0 || !answered) continue;
    EXPECT_NEAR(noise.deviation()[row], direct.deviation()[row], 1e-9 * nominal[row]);
    farthest = std::max(farthest, std::abs(std::log(noise.deviation()[row] / nominal[row])));
  }
  EXPECT_GT(farthest, std::log(1.5)) << "a slow wheel scatters otherwise";

  noise.respond(Eigen::MatrixXd::Zero(nominal.size(), 3), std::vector<double>(noise.used().size(), 9.0));
  noise.set(noise.scales());
  EXPECT_EQ(noise.deviation(), nominal)
      << "rows that a fit does not answer keep what the model was made with";
}

// A search along one scale after the other in steps of a quarter of a logarithm would stop beside the top.
TEST(ScatterAround, EstimatedScalesAreTheMostProbableOnes) {
  const DriveCampaign campaign = some_drives(6);
  const DiagnosisOptions options;
  NoProgress progress;
  const auto prepared = prepare(campaign, options, progress);
  ASSERT_TRUE(prepared);
  NoiseModel& noise = *prepared->noise;
  const LinearProblem problem = unwhitened_problem(*prepared->null, prepared->null->hypothesis.parameters());
  noise.estimate(problem.residuals, problem.columns);
  const NoiseScales found = noise.scales();
  const auto log_probability = [&](const NoiseScales& scales) {
    noise.set(scales);
    const Eigen::VectorXd residuals = noise.whiten(problem.residuals);
    return log_marginal(residuals, noise.whiten(problem.columns)) + noise.log_normalisation();
  };
  const double top = log_probability(found);
  for (int k = 0; k < kNoiseScales; ++k)
    for (const double step : {-0.1, 0.1}) {
      NoiseScales beside = found;
      *numbers_of(beside)[static_cast<std::size_t>(k)] *= std::exp(step);
      EXPECT_LT(log_probability(beside), top) << kScaleNames[static_cast<std::size_t>(k)] << " " << step;
    }
}

}  // namespace
}  // namespace slipway::gap
