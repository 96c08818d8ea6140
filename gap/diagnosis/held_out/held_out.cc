#include "gap/diagnosis/held_out/held_out.h"

#include <cmath>

namespace slipway::gap {
namespace {

FitOptions fit_options_of(const DiagnosisOptions& options) {
  FitOptions of_folds = options.fit;
  of_folds.max_iterations = options.held_out.max_iterations;
  return of_folds;
}

}  // namespace

Correction refitted(const PreparedCampaign& prepared, const FittedExplanation& explanation,
                    const DiagnosisOptions& options) {
  return [&](const FittedExplanation&, const std::vector<bool>& seen) {
    return fit_explanation(explanation.hypothesis, *prepared.model, *prepared.noise,
                           ModeStart::at(explanation), fit_options_of(options), options.search.threads, seen)
        .residuals;
  };
}

Correction uncorrected() {
  return [](const FittedExplanation& retuned, const std::vector<bool>&) { return retuned.residuals; };
}

FittedExplanation retuned_on(const PreparedCampaign& prepared, const std::vector<bool>& seen,
                             const DiagnosisOptions& options) {
  return fit_explanation(prepared.null->hypothesis, *prepared.model, *prepared.noise,
                         ModeStart::at(*prepared.null), fit_options_of(options), options.search.threads,
                         seen);
}

std::vector<bool> rows_of(const WindowModel& model, const std::vector<bool>& drives) {
  std::vector<bool> rows(model.observation_count(), false);
  for (std::size_t w = 0; w < model.windows().size(); ++w)
    for (std::size_t i = 0; i < model.windows()[w].observations.size(); ++i)
      rows[model.offset(w) + i] = drives[model.windows()[w].drive];
  return rows;
}

void HeldOutErrors::add(const HeldOutErrors& e) {
  for (std::size_t c = 0; c < channel_count(); ++c) {
    nominal[c] += e.nominal[c];
    retuned[c] += e.retuned[c];
    with[c] += e.with[c];
    floor[c] += e.floor[c];
    count[c] += e.count[c];
  }
  scaled_nominal += e.scaled_nominal;
  scaled_retuned += e.scaled_retuned;
  scaled_with += e.scaled_with;
  scaled_count += e.scaled_count;
  log_gain += e.log_gain;
}

HeldOutComparison::HeldOutComparison(const PreparedCampaign& prepared, const Eigen::VectorXd& retuned,
                                     const Eigen::VectorXd& corrected, const FitOptions& options)
    : prepared_(prepared),
      loss_{options.huber},
      retuned_(retuned),
      corrected_(corrected),
      white_retuned_(prepared.noise->whiten(retuned)),
      white_corrected_(prepared.noise->whiten(corrected)) {}

bool HeldOutComparison::compares(std::size_t window, std::size_t observation) const {
  const DriveWindow& of = prepared_.windows[window];
  const auto row = static_cast<Eigen::Index>(prepared_.model->offset(window) + observation);
  return prepared_.noise->deviation()[row] > 0.0 && std::isfinite(prepared_.nominal_residuals[row]) &&
         !(of.censored && of.observations[observation].channel == Channel::kSlip);
}

HeldOutErrors HeldOutComparison::errors(std::size_t window) const {
  HeldOutErrors e;
  for (std::size_t i = 0; i < prepared_.windows[window].observations.size(); ++i) {
    if (!compares(window, i)) continue;
    const auto row = static_cast<Eigen::Index>(prepared_.model->offset(window) + i);
    const auto c = static_cast<std::size_t>(prepared_.windows[window].observations[i].channel);
    const double deviation = prepared_.noise->deviation()[row], nominal = prepared_.nominal_residuals[row];
    const auto square = [](double x) { return x * x; };
    e.nominal[c] += square(nominal);
    e.retuned[c] += square(retuned_[row]);
    e.with[c] += square(corrected_[row]);
    e.floor[c] += square(deviation);
    e.count[c] += 1.0;
    e.scaled_nominal += square(nominal / deviation);
    e.scaled_retuned += square(retuned_[row] / deviation);
    e.scaled_with += square(corrected_[row] / deviation);
    e.scaled_count += 1.0;
    e.log_gain += loss_(white_retuned_[row]) - loss_(white_corrected_[row]);
  }
  return e;
}

}  // namespace slipway::gap
