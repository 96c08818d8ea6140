#include "gap/diagnosis/search/prepared_campaign.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "gap/diagnosis/model/difference_columns.h"
#include "gap/diagnosis/model/reference_belief.h"
#include "gap/diagnosis/model/smooth_difference.h"
#include "gap/diagnosis/search/like_drives.h"

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

// What is left open, in the directions that show most beside the noise, `most` of them: few say nearly all.
Eigen::MatrixXd main_directions(const Eigen::MatrixXd& left, const WindowModel& model,
                                std::span<const double> expected, const NoiseScales& noise,
                                const ReferenceOptions& options, Eigen::Index most) {
  // Where the model leaves nothing over, nothing is open.
  if (left.cols() == 0) return left;
  Eigen::MatrixXd scaled = left;
  Eigen::Index row = 0;
  for (const DriveWindow& window : model.windows())
    for (const Observation& o : window.observations) {
      const double value = expected[static_cast<std::size_t>(row)];
      scaled.row(row++) /=
          std::hypot(o.sensor_std, row_of(o.channel).left_over(noise, std::isfinite(value) ? value : 0.0));
    }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled.transpose() * scaled);
  const Eigen::Index n = left.cols();
  Eigen::Index kept = 0;
  while (kept < std::min(n, most) && solver.eigenvalues()[n - 1 - kept] > options.min_open) ++kept;
  return left * solver.eigenvectors().rightCols(kept);
}

// The difference that a reference told of, in the windows of a campaign; `expected` is predicted without it.
LearntDifference difference_of(const ReferenceBelief& belief, const Hypothesis& hypothesis,
                               const WindowModel& model, std::span<const double> expected,
                               const ReferenceOptions& options, std::size_t threads) {
  const std::vector<double> neutral = hypothesis.neutral();
  const Eigen::MatrixXd columns = difference_columns(model, neutral, expected, belief.scale, threads);
  const Eigen::MatrixXd beyond = columns_beyond(model, expected, belief.scale, belief.range);
  // Beyond what was learnt every direction is open: one that is left out would be taken for known.
  const Eigen::MatrixXd learnt_open =
      main_directions(columns * belief.root, model, expected, belief.noise, options, options.max_open);
  const Eigen::MatrixXd beyond_open =
      main_directions(options.beyond * beyond, model, expected, belief.noise, options, beyond.cols());
  Eigen::MatrixXd open(columns.rows(), learnt_open.cols() + beyond_open.cols());
  open << learnt_open, beyond_open;
  LearntDifference learnt{columns * belief.coefficients, columns * belief.slope, neutral, open};
  Eigen::VectorXd left = measured(model) - learnt.offset;
  for (Eigen::Index i = 0; i < left.size(); ++i) left[i] -= expected[static_cast<std::size_t>(i)];
  learnt.offset += repeated_part(belief.seen, model, left);
  for (Eigen::Index p = 0; p < learnt.slope.cols(); ++p)
    learnt.slope.col(p) /= hypothesis.parameters()[static_cast<std::size_t>(p)].std;
  return learnt;
}

// Why the drives are more than can be held. Windows are as long as three rows, so that fewer rows make fewer
// of them.
std::optional<Fault> too_many(std::span<const DriveWindow> windows, const DiagnosisOptions& options) {
  std::size_t observations = 0;
  for (const DriveWindow& window : windows) observations += window.observations.size();
  const auto most = static_cast<std::size_t>(options.preparation.max_observations);
  if (observations <= most) return std::nullopt;
  const double times = static_cast<double>(observations) / static_cast<double>(most);
  return Fault{
      "/drives",
      fmt::format("the drives give {} observations in {} windows, and {} can be held: leave out drives "
                  "(of each kind all but a few), or leave out rows until they are {:.2f} m of "
                  "commanded way apart, so that windows grow {:.1f} times as long",
                  observations, windows.size(), most, 0.5 * times * options.windows.length_m, times)};
}

// Derivatives by the three logarithms that scatter, of all soils together.
Eigen::MatrixXd soil_response(const Hypothesis& hypothesis, const Eigen::MatrixXd& jacobian) {
  constexpr std::array kScattered{SoilQuantity::kStiffness, SoilQuantity::kFriction,
                                  SoilQuantity::kShearModulus};
  Eigen::MatrixXd response = Eigen::MatrixXd::Zero(jacobian.rows(), kScattered.size());
  const auto parameters = hypothesis.parameters();
  for (std::size_t p = 0; p < parameters.size(); ++p)
    for (std::size_t k = 0; k < kScattered.size(); ++k)
      if (parameters[p].quantity == kScattered[k])
        response.col(static_cast<Eigen::Index>(k)) +=
            jacobian.col(static_cast<Eigen::Index>(p)) / parameters[p].std;
  return response;
}

NoiseOptions noise_options_of(const DriveCampaign& campaign, const DiagnosisOptions& options) {
  NoiseOptions noise = options.noise;
  if (!campaign.reference) return noise;
  noise.initial = campaign.reference->noise;
  noise.prior_std = options.reference.noise_std;
  return noise;
}

}  // namespace

std::string first_look_words(const PreparedCampaign& prepared, const sim::RoverModel& rover) {
  struct Sum {
    double squares = 0.0;
    int count = 0;
    double rms() const { return std::sqrt(squares / count); }
  };
  std::map<std::pair<Channel, int>, Sum> sums;
  for (std::size_t w = 0; w < prepared.windows.size(); ++w)
    for (std::size_t i = 0; i < prepared.windows[w].observations.size(); ++i) {
      const Observation& o = prepared.windows[w].observations[i];
      const auto row = static_cast<Eigen::Index>(prepared.model->offset(w) + i);
      const double deviations = prepared.nominal_residuals[row] / prepared.noise->deviation()[row];
      if (row_of(o.channel).of_the_stance || !std::isfinite(deviations)) continue;
      Sum& sum = sums[{o.channel, o.wheel}];
      sum.squares += deviations * deviations;
      ++sum.count;
    }
  if (sums.empty()) return "no reading of use";
  const auto most = std::max_element(
      sums.begin(), sums.end(), [](const auto& a, const auto& b) { return a.second.rms() < b.second.rms(); });
  const auto [channel, wheel] = most->first;
  const std::string of =
      wheel < 0 ? "" : fmt::format(" of {}", rover.wheels[static_cast<std::size_t>(wheel)].name);
  return fmt::format("before any re-tuning, {}{} is {:.1f} times its usual scatter off what was predicted",
                     name_of(channel), of, most->second.rms());
}

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
  Eigen::MatrixXd response(jacobian.rows(), 7);
  response << soil_response(hypothesis, jacobian), levers.leftCols(4);
  return response;
}

void scatter_around(const FittedExplanation& fit, const WindowModel& model, NoiseModel& noise) {
  const Eigen::VectorXd expected = measured(model) - fit.residuals;
  noise.respond(soil_response(fit.hypothesis, fit.jacobian),
                {expected.data(), static_cast<std::size_t>(expected.size())});
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
  const Eigen::MatrixXd& precision = found.hypothesis.prior_precision();
  LinearProblem problem = unwhitened_problem(found, found.hypothesis.parameters());
  if (precision.size() > 0) problem.columns *= prior_root(precision);
  const LearntDifference* const learnt = prepared.model->learnt();
  const Eigen::MatrixXd left = learnt != nullptr ? learnt->left : Eigen::MatrixXd(found.jacobian.rows(), 0);
  Eigen::MatrixXd systematic(problem.columns.rows(),
                             problem.columns.cols() + left.cols() + prepared.discrepancy.values.cols());
  systematic << problem.columns, left, prepared.discrepancy.values;
  scatter_around(found, *prepared.model, *prepared.noise);
  prepared.noise->estimate(problem.residuals, systematic, threads);
  const auto fitted = [&](const ModeStart& start) {
    return fit_explanation(prepared.null->hypothesis, *prepared.model, *prepared.noise, start, options.fit,
                           threads);
  };
  FittedExplanation null = fitted(ModeStart::at(*prepared.null));
  if (!campaign.reference) keep_better(null, fitted(prepared.null->hypothesis.neutral()));
  prepared.null = std::move(null);
  prepared.model->start_from(prepared.null->hypothesis.state(prepared.null->x), threads);
}

Result<PreparedCampaign> prepare_as_believed(const DriveCampaign& campaign, const DiagnosisOptions& options,
                                             Progress& progress, const std::vector<bool>& looked_at) {
  const std::size_t threads = options.search.threads;
  PreparedCampaign made;
  progress.report("cutting drives into windows", 0.0);
  made.windows = cut_windows(campaign, options.windows);
  if (auto fault = too_many(made.windows, options))
    return fail(ErrorCode::kPayloadTooLarge, fault->message, {*fault});
  made.model = campaign.reference
                   ? std::make_unique<WindowModel>(campaign, made.windows, campaign.reference->footing)
                   : window_model_of(campaign, made.windows, options.preparation, threads);
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
  if (campaign.reference)
    made.model->learn(difference_of(*campaign.reference, hypothesis, model,
                                    hypothesis.predict(model, neutral, threads), options.reference, threads));
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
      expected, used, noise_options_of(campaign, options));
  return made;
}

Result<PreparedCampaign> prepare(const DriveCampaign& campaign, const DiagnosisOptions& options,
                                 Progress& progress, const std::vector<bool>& looked_at) {
  auto believed = prepare_as_believed(campaign, options, progress, looked_at);
  if (!believed) return fail(believed.error());
  PreparedCampaign made = std::move(*believed);
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
  progress.report(first_look_words(made, *campaign.rover), 0.04);
  const Hypothesis hypothesis(campaign, {});
  made.null = fit_explanation(hypothesis, *made.model, *made.noise, hypothesis.neutral(), options.fit,
                              options.search.threads);
  for (int round = 0; round < options.preparation.scatter_rounds; ++round) {
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
    progress.report("estimating the drives' own scatter", 0.06 + 0.05 * round);
    prepare_around(made, campaign, *made.null, options);
  }
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
  return made;
}

}  // namespace slipway::gap
