#include "gap/diagnosis/search/prepared_campaign.h"

#include <cmath>
#include <string_view>

namespace slipway::gap {
namespace {

// A rigid frame on uneven ground would stand on three of its wheels. Real ones have tyres and give: where no
// attitude was recorded that says otherwise, they stand on the plane.
bool stands_on_plane(const DriveCampaign& campaign, const WindowModel& model) {
  return campaign.rover->suspension.type == sim::SuspensionType::kRigid &&
         std::isnan(model.attitude_misfit_rad());
}

// Some recordings, of simulators above all, show the attitude that the rover has before its wheels sink.
bool shows_undisturbed(const DriveCampaign& campaign, const WindowModel& leant,
                       const WindowModel& undisturbed, std::size_t threads) {
  if (std::isnan(leant.attitude_misfit_rad())) return false;
  const Hypothesis hypothesis(campaign, {});
  const std::vector<double> neutral = hypothesis.neutral();
  return undisturbed.attitude_scatter_rad(hypothesis.predict(undisturbed, neutral, threads)) <
         leant.attitude_scatter_rad(hypothesis.predict(leant, neutral, threads));
}

}  // namespace

std::unique_ptr<WindowModel> window_model_of(const DriveCampaign& campaign,
                                             std::span<const DriveWindow> windows,
                                             const PreparationOptions& options, std::size_t threads) {
  auto suspension = std::make_unique<WindowModel>(campaign, windows);
  auto plane = std::make_unique<WindowModel>(campaign, windows, Footing::kPlane);
  const bool nearer = plane->attitude_misfit_rad() <
                          options.plane_is_nearer * suspension->attitude_misfit_rad() ||  // false for NaN
                      stands_on_plane(campaign, *suspension);
  if (nearer) return plane;
  auto undisturbed = std::make_unique<WindowModel>(campaign, windows, Footing::kUndisturbed);
  return shows_undisturbed(campaign, *suspension, *undisturbed, threads) ? std::move(undisturbed)
                                                                         : std::move(suspension);
}

Eigen::MatrixXd scatter_response(const Hypothesis& hypothesis, const Eigen::MatrixXd& jacobian,
                                 const Eigen::MatrixXd& levers) {
  constexpr std::array kScattered{SoilQuantity::kStiffness, SoilQuantity::kFriction,
                                  SoilQuantity::kShearModulus};
  Eigen::MatrixXd response = Eigen::MatrixXd::Zero(jacobian.rows(), kScattered.size() + 4);
  response.rightCols(4) = levers.leftCols(4);
  const auto parameters = hypothesis.parameters();
  for (std::size_t p = 0; p < parameters.size(); ++p)
    for (std::size_t k = 0; k < kScattered.size(); ++k)
      if (parameters[p].quantity == kScattered[k])
        response.col(static_cast<Eigen::Index>(k)) +=
            jacobian.col(static_cast<Eigen::Index>(p)) / parameters[p].std;
  return response;
}

std::size_t PreparedCampaign::used_windows() const {
  std::size_t count = 0;
  for (std::size_t w = 0; w < windows.size(); ++w) count += model->used(w) ? 1 : 0;
  return count;
}

void prepare_around(PreparedCampaign& prepared, const DriveCampaign& campaign, const FittedExplanation& found,
                    const DiagnosisOptions& options) {
  const std::size_t threads = options.search.threads;
  prepared.model->start_from(found.hypothesis.state(found.x), threads);
  prepared.discrepancy =
      make_discrepancy_term(campaign, *prepared.model, found, options.discrepancy, threads);
  Eigen::MatrixXd systematic(found.jacobian.rows(),
                             found.jacobian.cols() + prepared.discrepancy.values.cols());
  systematic << found.jacobian, prepared.discrepancy.values;
  prepared.noise->estimate(
      found.residuals + found.jacobian * in_prior_units(found.hypothesis.parameters(), found.x), systematic);
  const std::vector<double> start = prepared.null->x;
  prepared.null = fit_explanation(prepared.null->hypothesis, *prepared.model, *prepared.noise, start,
                                  options.fit, threads);
  prepared.model->start_from(prepared.null->hypothesis.state(prepared.null->x), threads);
}

Result<PreparedCampaign> prepare(const DriveCampaign& campaign, const DiagnosisOptions& options,
                                 Progress& progress, const std::vector<bool>& looked_at) {
  const std::size_t threads = options.search.threads;
  PreparedCampaign made;
  progress.report("cutting drives into windows", 0.0);
  made.windows = cut_windows(campaign, options.windows);
  made.model = window_model_of(campaign, made.windows, options.preparation, threads);
  made.model->watch(progress);
  const WindowModel& model = *made.model;
  std::vector<bool> used(model.observation_count(), false);
  for (std::size_t w = 0; w < made.windows.size(); ++w)
    for (std::size_t i = 0; model.used(w) && i < made.windows[w].observations.size(); ++i)
      used[model.offset(w) + i] =
          looked_at.empty() || looked_at[static_cast<std::size_t>(made.windows[w].observations[i].channel)];
  const Hypothesis hypothesis(campaign, {});
  const std::vector<double> neutral = hypothesis.neutral();
  made.model->start_from(hypothesis.state(neutral), threads);
  std::vector<double> expected = hypothesis.predict(model, neutral, threads);
  made.nominal_residuals = measured(model);
  for (std::size_t i = 0; i < expected.size(); ++i)
    made.nominal_residuals[static_cast<Eigen::Index>(i)] -= expected[i];
  for (std::size_t i = 0; i < expected.size(); ++i)
    if (!std::isfinite(expected[i])) expected[i] = 0.0;

  progress.report("fitting soil and closures", 0.02);
  const Eigen::MatrixXd jacobian = hypothesis.scaled_jacobian(model, neutral, threads);
  made.noise = std::make_unique<NoiseModel>(
      model,
      scatter_response(hypothesis, jacobian,
                       lever_responses(campaign, model, neutral, options.discrepancy, threads)),
      expected, used, options.noise);
  made.null = fit_explanation(hypothesis, model, *made.noise, neutral, options.fit, threads);
  for (int round = 0; round < options.preparation.scatter_rounds; ++round) {
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
    progress.report("estimating the drives' own scatter", 0.06 + 0.05 * round);
    prepare_around(made, campaign, *made.null, options);
  }
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
  return made;
}

}  // namespace slipway::gap
