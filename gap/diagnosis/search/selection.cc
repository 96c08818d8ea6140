#include "gap/diagnosis/search/selection.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/parallel_for.h"

namespace slipway::gap {
namespace {

std::size_t simplest_of_the_best(std::span<const Candidate> candidates, const SelectionOptions& options) {
  std::size_t best = 0;
  if (candidates.front().probability >= options.certain) return best;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    const Candidate &held = candidates[best], &other = candidates[i];
    const auto in_held = [&](const std::string& effect) {
      return std::find(held.effects.begin(), held.effects.end(), effect) != held.effects.end();
    };
    if (!other.effects.empty() && other.effects.size() < held.effects.size() &&
        other.with_unknown == held.with_unknown &&
        std::all_of(other.effects.begin(), other.effects.end(), in_held) &&
        other.probability > options.simpler_share * candidates.front().probability)
      best = i;
  }
  return best;
}

// Whether explanations without an effect of the library are more probable in all than those with one of
// these.
bool rather_without(const std::vector<std::string>& effects, std::span<const Candidate> candidates) {
  double with = 0.0, without = 0.0;
  for (const Candidate& c : candidates) {
    const std::vector<std::string> own = library_effects_of(c);
    const bool has_one = std::any_of(own.begin(), own.end(), [&](const std::string& effect) {
      return std::find(effects.begin(), effects.end(), effect) != effects.end();
    });
    if (own.empty()) without += c.probability;
    if (has_one) with += c.probability;
  }
  return without > with;
}

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

std::size_t chosen_among(std::span<const Candidate> candidates, const SelectionOptions& options) {
  double unknown = 0.0;
  for (const Candidate& c : candidates) unknown += c.unknown() ? c.probability : 0.0;
  const auto first_where = [&](const auto& holds) {
    return static_cast<std::size_t>(std::find_if(candidates.begin(), candidates.end(), holds) -
                                    candidates.begin());
  };
  if (unknown > options.unknown_majority) return first_where([](const Candidate& c) { return c.unknown(); });
  const std::size_t best = simplest_of_the_best(candidates, options);
  const std::vector<std::string> effects = library_effects_of(candidates[best]);
  if (effects.empty() || !rather_without(effects, candidates)) return best;
  return first_where([](const Candidate& c) { return library_effects_of(c).empty(); });
}

std::size_t best_form(const ExplanationSearch& search, std::size_t chosen, double alike_share) {
  const Candidate& first = search.candidates[chosen];
  if (!first.outside || first.with_unknown) return chosen;
  std::size_t best = chosen;
  for (std::size_t c = 0; c < search.candidates.size(); ++c) {
    const Candidate& other = search.candidates[c];
    if (other.outside && !other.with_unknown && other.probability >= alike_share * first.probability &&
        library_effects_of(other) == library_effects_of(first) &&
        search.fits[other.fit].log_evidence > search.fits[search.candidates[best].fit].log_evidence)
      best = c;
  }
  return best;
}

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

std::size_t chosen_of_resample(std::vector<Candidate> candidates, const EvidenceOptions& evidence,
                               const SelectionOptions& selection) {
  weigh(candidates, evidence);
  std::vector<std::size_t> order(candidates.size());
  for (std::size_t c = 0; c < order.size(); ++c) order[c] = c;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t z) {
    return candidates[a].probability > candidates[z].probability;
  });
  std::vector<Candidate> sorted;
  sorted.reserve(order.size());
  for (const std::size_t c : order) sorted.push_back(candidates[c]);
  return order[chosen_among(sorted, selection)];
}

SelectionBootstrap resample_selection(const ExplanationSearch& search, const PreparedCampaign& prepared,
                                      const DriveCampaign& campaign, const DiagnosisOptions& options,
                                      const DriveResampling& drives) {
  const WindowModel& model = *prepared.model;
  const Running running = running_of(search, prepared, campaign, options, drives);
  SelectionBootstrap answer;
  answer.chosen.resize(drives.resamples.size());
  answer.share.assign(search.candidates.size(), 0.0);
  parallel_for(drives.resamples.size(), options.search.threads, [&](std::size_t b) {
    if (model.cancelled()) return;
    std::vector<int> times(drives.group_count, 0);
    for (const std::size_t group : drives.resamples[b]) ++times[group];
    std::vector<Candidate> drawn = running.candidates;
    for (std::size_t c = 0; c < drawn.size(); ++c)
      drawn[c].log_evidence += running.evidence[c].counted(times) - running.whole[c];
    answer.chosen[b] = chosen_of_resample(std::move(drawn), options.evidence, options.selection);
  });
  for (const std::size_t chosen : answer.chosen)
    answer.share[chosen] += 1.0 / static_cast<double>(drives.resamples.size());
  return answer;
}

}  // namespace slipway::gap
