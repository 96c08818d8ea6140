#include "gap/diagnosis/search/reference_learning.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "gap/diagnosis/model/difference_columns.h"
#include "gap/diagnosis/model/reading_plausibility.h"
#include "gap/diagnosis/search/like_drives.h"

namespace slipway::gap {
namespace {

constexpr int kMaxSweeps = 3;

// log_marginal of residuals beside known columns and those of the difference, by the sizes of its groups.
class SizeEvidence {
 public:
  SizeEvidence(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& known, const Eigen::MatrixXd& columns,
               std::span<const std::size_t> groups)
      : groups_(groups), known_(known.cols()), residual_square_(residuals.squaredNorm()) {
    Eigen::MatrixXd all(columns.rows(), known.cols() + columns.cols());
    all << known, columns;
    squares_ = all.transpose() * all;
    products_ = all.transpose() * residuals;
  }

  double operator()(const std::vector<double>& of_group) const {
    // Columns of no size change nothing.
    std::vector<Eigen::Index> there;
    std::vector<double> sizes;
    for (Eigen::Index k = 0; k < squares_.cols(); ++k) {
      const double size = k < known_ ? 1.0 : of_group[groups_[static_cast<std::size_t>(k - known_)]];
      if (size == 0.0) continue;
      there.push_back(k);
      sizes.push_back(size);
    }
    const auto size =
        Eigen::Map<const Eigen::VectorXd>(sizes.data(), static_cast<Eigen::Index>(sizes.size()));
    return log_marginal(residual_square_, size.cwiseProduct(products_(there)),
                        size.asDiagonal() * squares_(there, there) * size.asDiagonal());
  }

 private:
  std::span<const std::size_t> groups_;
  Eigen::Index known_;
  double residual_square_;
  Eigen::MatrixXd squares_;
  Eigen::VectorXd products_;
};

// The sizes are raised and lowered in turn, a group at a time, from nothing.
std::vector<double> most_probable_sizes(const SizeEvidence& evidence, std::size_t groups,
                                        std::span<const double> candidates) {
  std::vector<double> best(groups, 0.0);
  double value = evidence(best);
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    bool better = false;
    for (std::size_t group = 0; group < groups; ++group)
      for (const double size : candidates) {
        std::vector<double> trial = best;
        if (std::exchange(trial[group], size) == size) continue;
        if (const double v = evidence(trial); v > value) {
          value = v;
          best = std::move(trial);
          better = true;
        }
      }
    if (!better) break;
  }
  return best;
}

// "friction/drift" whatever the number of soils.
std::string name_with_soil(const Parameter& parameter, const DriveCampaign& campaign) {
  if (parameter.soil < 0) return parameter.name;
  const std::string& soil = campaign.soils[static_cast<std::size_t>(parameter.soil)].name;
  return parameter.name.ends_with("/" + soil) ? parameter.name : parameter.name + "/" + soil;
}

std::vector<std::string> names_with_soils(const Hypothesis& hypothesis, const DriveCampaign& campaign) {
  std::vector<std::string> names;
  for (std::size_t p = 0; p < hypothesis.nuisance_count(); ++p)
    names.push_back(name_with_soil(hypothesis.parameters()[p], campaign));
  return names;
}

// M with M M^T = a covariance that may be singular; directions of almost none are left out.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& covariance) {
  constexpr double kLeast = 1e-10;  // of a coefficient's unit, squared
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  const Eigen::Index n = covariance.rows();
  Eigen::Index kept = 0;
  while (kept < n && solver.eigenvalues()[n - 1 - kept] > kLeast) ++kept;
  return solver.eigenvectors().rightCols(kept) *
         solver.eigenvalues().tail(kept).cwiseSqrt().asDiagonal().toDenseMatrix();
}

// Parameters and coefficients of the difference, each round from where the last one left them.
class Learner {
 public:
  Learner(const DriveCampaign& campaign, const DiagnosisOptions& options, LearntReference& learnt)
      : campaign_(campaign), options_(options), learnt_(learnt) {}

  void round() {
    PreparedCampaign& prepared = learnt_.prepared;
    FittedExplanation& fit = *prepared.null;
    const auto nuisances = static_cast<Eigen::Index>(fit.x.size());
    const Eigen::MatrixXd columns = columns_at(fit.x);
    const Eigen::MatrixXd white = fit.row_weights.asDiagonal() * prepared.noise->whiten(columns);
    // With what the difference explains put back, as the parameters' part is.
    Eigen::VectorXd residuals = fit.white_linear;
    if (offset_.size() > 0) residuals += fit.row_weights.asDiagonal() * prepared.noise->whiten(offset_);
    const std::vector<std::size_t> groups = difference_groups(*campaign_.rover);
    const std::vector<double> sizes =
        believed_sizes(residuals, fit.white_jacobian, white, groups, options_.reference.sizes);
    Eigen::VectorXd size(white.cols());
    for (Eigen::Index c = 0; c < size.size(); ++c) size[c] = sizes[groups[static_cast<std::size_t>(c)]];
    Eigen::MatrixXd all(white.rows(), nuisances + white.cols());
    all << fit.white_jacobian, white * size.asDiagonal();
    Eigen::MatrixXd precision = all.transpose() * all;
    precision.diagonal().array() += 1.0;
    const Eigen::LLT<Eigen::MatrixXd> llt(precision);
    const Eigen::VectorXd solved = llt.solve(all.transpose() * residuals);
    learnt_.covariance = llt.solve(Eigen::MatrixXd::Identity(all.cols(), all.cols()));
    learnt_.covariance.rightCols(size.size()) *= size.asDiagonal();
    learnt_.covariance.bottomRows(size.size()) =
        size.asDiagonal() * learnt_.covariance.bottomRows(size.size());
    learnt_.coefficients = size.cwiseProduct(solved.tail(size.size()));
    place(solved.head(nuisances));
    believe(columns);
  }

  // Measured less what parameters and difference say.
  Eigen::VectorXd left_over() const {
    const WindowModel& model = *learnt_.prepared.model;
    const std::vector<double> said =
        learnt_.prepared.null->hypothesis.predict(model, x_, options_.search.threads);
    return measured(model) -
           Eigen::Map<const Eigen::VectorXd>(said.data(), static_cast<Eigen::Index>(said.size()));
  }

  // The fit with the difference that was learnt beside it.
  void refit() {
    PreparedCampaign& prepared = learnt_.prepared;
    prepared.null = fit_explanation(prepared.null->hypothesis, *prepared.model, *prepared.noise, x_,
                                    options_.fit, options_.search.threads);
  }

 private:
  // Where model and difference are linearised: the difference is a function of what the model says of itself.
  Eigen::MatrixXd columns_at(const std::vector<double>& x) {
    WindowModel& model = *learnt_.prepared.model;
    model.learn(nothing(x));
    std::vector<double> expected =
        learnt_.prepared.null->hypothesis.predict(model, x, options_.search.threads);
    if (learnt_.scale.unit.empty()) learnt_.scale = smooth_scale(model, expected);
    learnt_.range = smooth_range(model, expected);
    return difference_columns(model, x, expected, learnt_.scale, options_.search.threads);
  }

  LearntDifference nothing(const std::vector<double>& x) const {
    const auto rows = static_cast<Eigen::Index>(learnt_.prepared.model->observation_count());
    return {Eigen::VectorXd::Zero(rows), Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(x.size())), x,
            Eigen::MatrixXd(rows, 0)};
  }

  void place(const Eigen::VectorXd& u) {
    const auto parameters = learnt_.prepared.null->hypothesis.parameters();
    x_.clear();
    for (std::size_t p = 0; p < parameters.size(); ++p)
      x_.push_back(std::clamp(parameters[p].neutral + parameters[p].std * u[static_cast<Eigen::Index>(p)],
                              parameters[p].lowest, parameters[p].highest));
    learnt_.mean = Eigen::Map<const Eigen::VectorXd>(x_.data(), static_cast<Eigen::Index>(x_.size()));
  }

  void believe(const Eigen::MatrixXd& columns) {
    LearntDifference difference = nothing(x_);
    difference.offset = offset_ = columns * learnt_.coefficients;
    learnt_.prepared.model->learn(std::move(difference));
  }

  const DriveCampaign& campaign_;
  const DiagnosisOptions& options_;
  LearntReference& learnt_;
  std::vector<double> x_;
  Eigen::VectorXd offset_;  // of every observation, as it was learnt last
};

}  // namespace

std::vector<double> believed_sizes(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& known,
                                   const Eigen::MatrixXd& columns, std::span<const std::size_t> groups,
                                   std::span<const double> sizes) {
  const SizeEvidence evidence(residuals, known, columns, groups);
  const std::size_t count = groups.empty() ? 0 : *std::max_element(groups.begin(), groups.end()) + 1;
  std::vector<double> candidates(sizes.begin(), sizes.end());
  candidates.push_back(0.0);
  const std::vector<double> best = most_probable_sizes(evidence, count, candidates);
  const double most = evidence(best);
  std::vector<double> believed = best;
  for (std::size_t group = 0; group < count; ++group) {
    double weights = 0.0, squares = 0.0;
    for (const double size : candidates) {
      std::vector<double> trial = best;
      trial[group] = size;
      const double weight = std::exp(evidence(trial) - most);
      weights += weight;
      squares += weight * size * size;
    }
    believed[group] = std::sqrt(squares / weights);
  }
  return believed;
}

Result<LearntReference> learn_reference(const DriveCampaign& reference, const DiagnosisOptions& options,
                                        Progress& progress) {
  auto prepared = prepare(reference, options, progress);
  if (!prepared) return fail(prepared.error());
  LearntReference learnt;
  learnt.prepared = std::move(*prepared);
  if (learnt.prepared.used_windows() == 0)
    return fail(ErrorCode::kInvalidRequest,
                fmt::format("the healthy drives of {} have no window of use", reference.name),
                {{"/reference", "must have a drive with two rows of position and attitude on the terrain"}});
  learnt.names = names_with_soils(learnt.prepared.null->hypothesis, reference);
  Learner learner(reference, options, learnt);
  for (int round = 0; round < options.reference.rounds; ++round) {
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
    progress.report("learning what the reference drives leave over", 0.16);
    if (round > 0) learner.refit();
    learner.round();
  }
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
  learnt.left_over = learner.left_over();
  return learnt;
}

std::shared_ptr<const ReferenceBelief> belief_for(const LearntReference& learnt,
                                                  const DriveCampaign& campaign,
                                                  const ReferenceOptions& options) {
  auto belief = std::make_shared<ReferenceBelief>();
  const DriveCampaign& reference = learnt.prepared.model->campaign();
  belief->campaign = reference.name;
  belief->fingerprint = reference.fingerprint;
  belief->drives = reference.drives.size();
  belief->windows = learnt.prepared.used_windows();
  for (const std::string& note : notes_of_implausible_readings(reference))
    belief->implausible.push_back("of the healthy drives " + note);
  const Hypothesis hypothesis(campaign, {});
  const std::vector<std::string> asked = names_with_soils(hypothesis, campaign);
  const auto count = static_cast<Eigen::Index>(asked.size()), coefficients = learnt.coefficients.size();
  const auto known = static_cast<Eigen::Index>(learnt.names.size());
  belief->mean.resize(count);
  Eigen::MatrixXd own = Eigen::MatrixXd::Identity(count, count);
  Eigen::MatrixXd crossed = Eigen::MatrixXd::Zero(coefficients, count);
  std::vector<Eigen::Index> of;
  Eigen::VectorXd deviation(count);  // of the reference's prior, in those of the new drives
  for (std::size_t p = 0; p < asked.size(); ++p) {
    const std::size_t place = place_in(learnt.names, asked[p]);
    const bool there = place < learnt.names.size();
    of.push_back(there ? static_cast<Eigen::Index>(place) : -1);
    deviation[static_cast<Eigen::Index>(p)] =
        there ? learnt.prepared.null->hypothesis.parameters()[place].std / hypothesis.parameters()[p].std
              : 1.0;
  }
  for (Eigen::Index p = 0; p < count; ++p) {
    const Parameter& parameter = hypothesis.parameters()[static_cast<std::size_t>(p)];
    const Eigen::Index at = of[static_cast<std::size_t>(p)];
    belief->names.push_back(parameter.name);
    belief->mean[p] = at < 0 ? parameter.neutral : learnt.mean[at];
    if (at < 0) continue;
    crossed.col(p) = deviation[p] * learnt.covariance.block(known, at, coefficients, 1);
    for (Eigen::Index q = 0; q < count; ++q)
      if (const Eigen::Index other = of[static_cast<std::size_t>(q)]; other >= 0)
        own(p, q) = deviation[p] * deviation[q] * learnt.covariance(at, other);
    own(p, p) += options.drift * options.drift;
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(own);
  belief->precision = llt.solve(Eigen::MatrixXd::Identity(count, count));
  belief->scale = learnt.scale;
  belief->range = learnt.range;
  belief->coefficients = learnt.coefficients;
  belief->slope = crossed * belief->precision;
  const Eigen::MatrixXd left =
      learnt.covariance.bottomRightCorner(coefficients, coefficients) - belief->slope * crossed.transpose();
  belief->root = root_of(left);
  belief->noise = learnt.prepared.noise->scales();
  belief->seen = seen_windows(*learnt.prepared.model, learnt.left_over);
  belief->footing = learnt.prepared.model->footing();
  return belief;
}

}  // namespace slipway::gap
