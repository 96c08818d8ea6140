#include "gap/diagnosis/search/selection.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/parallel_for.h"

namespace slipway::gap {
namespace {

// The explanations that resamples choose among, most probable first, with their linearised evidence.
struct Running {
  std::vector<Candidate> candidates;
  std::vector<GroupedEvidence> evidence;
  std::vector<double> whole;  // of all drives, once each
};

Running running_of(const ExplanationSearch& search, const PreparedCampaign& prepared,
                   const DriveCampaign& campaign, const DiagnosisOptions& options,
                   const DriveResampling& drives) {
  const WindowModel& model = *prepared.model;
  std::vector<std::size_t> group_of_row(model.observation_count());
  for (std::size_t w = 0; w < model.windows().size(); ++w)
    for (std::size_t i = 0; i < model.windows()[w].observations.size(); ++i)
      group_of_row[model.offset(w) + i] = drives.groups[model.windows()[w].drive];
  const std::vector<int> once(drives.group_count, 1);
  const SelectionOptions& limits = options.selection;
  Running running;
  for (const Candidate& c : search.candidates) {
    if (c.probability < limits.min_running ||
        running.candidates.size() >= static_cast<std::size_t>(limits.max_running))
      break;
    const FittedExplanation& fit = search.fits[c.fit];
    const Eigen::MatrixXd form =
        form_columns(campaign, model, *prepared.noise, fit, options.discrepancy, options.search.threads);
    running.candidates.push_back(c);
    running.evidence.emplace_back(
        linear_problem(fit).residuals,
        columns_beside(fit, whitened(fit, *prepared.noise, prepared.discrepancy), form, c.with_unknown,
                       options.discrepancy, [&] { return model.cancelled(); }),
        group_of_row, drives.group_count);
    running.whole.push_back(running.evidence.back().counted(once));
  }
  return running;
}

}  // namespace

GroupedEvidence::GroupedEvidence(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& columns,
                                 std::span<const std::size_t> group_of_row, std::size_t group_count)
    : square_(group_count, 0.0),
      gradient_(group_count, Eigen::VectorXd::Zero(columns.cols())),
      hessian_(group_count, Eigen::MatrixXd::Zero(columns.cols(), columns.cols())) {
  std::vector<std::vector<Eigen::Index>> rows(group_count);
  for (std::size_t row = 0; row < group_of_row.size(); ++row)
    rows[group_of_row[row]].push_back(static_cast<Eigen::Index>(row));
  for (std::size_t g = 0; g < group_count; ++g) {
    const Eigen::MatrixXd part = columns(rows[g], Eigen::all);
    const Eigen::VectorXd left = residuals(rows[g]);
    square_[g] = left.squaredNorm();
    gradient_[g] = part.transpose() * left;
    hessian_[g] = part.transpose() * part;
  }
}

double GroupedEvidence::counted(std::span<const int> times) const {
  double square = 0.0;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(gradient_.front().size());
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Identity(gradient.size(), gradient.size());
  for (std::size_t g = 0; g < times.size(); ++g) {
    if (times[g] == 0) continue;
    square += times[g] * square_[g];
    gradient += times[g] * gradient_[g];
    hessian += times[g] * hessian_[g];
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(hessian);
  return -0.5 * (square - gradient.dot(factor.solve(gradient))) -
         factor.matrixLLT().diagonal().array().log().sum();
}

std::vector<double> resample_selection(const ExplanationSearch& search, const PreparedCampaign& prepared,
                                       const DriveCampaign& campaign, const DiagnosisOptions& options,
                                       const DriveResampling& drives) {
  const WindowModel& model = *prepared.model;
  const Running running = running_of(search, prepared, campaign, options, drives);
  std::vector<std::size_t> first(drives.resamples.size(), 0);
  parallel_for(drives.resamples.size(), options.search.threads, [&](std::size_t b) {
    if (model.cancelled()) return;
    std::vector<int> times(drives.group_count, 0);
    for (const std::size_t group : drives.resamples[b]) ++times[group];
    std::vector<Candidate> drawn = running.candidates;
    for (std::size_t c = 0; c < drawn.size(); ++c)
      drawn[c].log_evidence += running.evidence[c].counted(times) - running.whole[c];
    weigh(drawn, options.evidence);
    const auto less = [](const Candidate& a, const Candidate& z) { return a.probability < z.probability; };
    first[b] = static_cast<std::size_t>(std::max_element(drawn.begin(), drawn.end(), less) - drawn.begin());
  });
  std::vector<double> share(search.candidates.size(), 0.0);
  for (const std::size_t c : first) share[c] += 1.0 / static_cast<double>(drives.resamples.size());
  return share;
}

}  // namespace slipway::gap
