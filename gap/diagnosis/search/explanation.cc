#include "gap/diagnosis/search/explanation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace slipway::gap {
namespace {

// Steps by which soils are made stronger at most.
constexpr int kMaxStronger = 4;

// A hypothesis on recorded drives, as what a mode is searched of.
class SimulatedDrives : public FittedModel {
 public:
  SimulatedDrives(const Hypothesis& hypothesis, const WindowModel& model, const NoiseModel& noise,
                  std::size_t threads)
      : hypothesis_(hypothesis),
        model_(model),
        noise_(noise),
        threads_(threads),
        measured_(slipway::gap::measured(model)) {
    for (const DriveWindow& window : model.windows())
      stood_.insert(stood_.end(), window.observations.size(), window.censored);
  }

  std::span<const Parameter> parameters() const override { return hypothesis_.parameters(); }
  const Eigen::VectorXd& measured() const override { return measured_; }
  std::vector<double> predict(std::span<const double> x) const override {
    return hypothesis_.predict(model_, x, threads_);
  }
  Eigen::MatrixXd scaled_jacobian(std::span<const double> x,
                                  std::span<const double> predicted) const override {
    return hypothesis_.scaled_jacobian(model_, x, threads_, predicted);
  }
  Eigen::MatrixXd whiten(const Eigen::MatrixXd& columns) const override { return noise_.whiten(columns); }
  const Eigen::VectorXd& deviation() const override { return noise_.deviation(); }
  bool cancelled() const override { return model_.cancelled(); }
  bool stood(Eigen::Index row) const override { return stood_[static_cast<std::size_t>(row)]; }
  Eigen::MatrixXd prior_precision() const override { return hypothesis_.prior_precision(); }

 private:
  const Hypothesis& hypothesis_;
  const WindowModel& model_;
  const NoiseModel& noise_;
  std::size_t threads_;
  Eigen::VectorXd measured_;
  std::vector<bool> stood_;  // of each observation: its window is censored
};

// Where on stronger soils the model answers rows that it does not at the fit, a few steps of friction away.
std::optional<std::vector<double>> where_it_answers(const SimulatedDrives& drives,
                                                    const Hypothesis& hypothesis, const PosteriorMode& mode,
                                                    const FitOptions& options,
                                                    const std::vector<bool>& fitted_rows) {
  const auto parameters = hypothesis.parameters();
  std::vector<double> x = mode.x;
  for (int step = 0; step < kMaxStronger && !drives.cancelled(); ++step) {
    for (std::size_t p = 0; p < hypothesis.nuisance_count(); ++p)
      if (parameters[p].quantity == SoilQuantity::kFriction)
        x[p] = std::min(parameters[p].highest, x[p] + options.stronger_friction * parameters[p].std);
    if (unanswered_rows(drives, drives.predict(x), fitted_rows) < mode.unanswered) return x;
  }
  return std::nullopt;
}

bool leaves_open(const WindowModel& model) {
  return model.learnt() != nullptr && model.learnt()->left.cols() > 0;
}

// What reference drives left open of the difference stands beside every explanation.
void leave_open(const WindowModel& model, const NoiseModel& noise, FittedExplanation& fit) {
  if (!leaves_open(model)) return;
  const Eigen::MatrixXd& left = model.learnt()->left;
  Eigen::MatrixXd columns(fit.white_jacobian.rows(), fit.white_jacobian.cols() + left.cols());
  columns << fit.white_jacobian, fit.row_weights.asDiagonal() * noise.whiten(left);
  fit.log_evidence +=
      log_marginal(fit.white_linear, columns) - log_marginal(fit.white_linear, fit.white_jacobian);
  fit.white_jacobian = std::move(columns);
}

}  // namespace

std::vector<double> started_at(const Hypothesis& hypothesis, const FittedExplanation& other) {
  std::vector<double> start = hypothesis.neutral();
  const auto own = hypothesis.parameters(), there = other.hypothesis.parameters();
  for (std::size_t p = 0; p < own.size(); ++p)
    for (std::size_t q = 0; q < there.size(); ++q)
      if (own[p].name == there[q].name) start[p] = other.x[q];
  return start;
}

Eigen::MatrixXd added_derivatives(const Hypothesis& hypothesis, const WindowModel& model,
                                  const FittedExplanation& fit, std::vector<double>& start,
                                  std::span<const double> predicted) {
  start = started_at(hypothesis, fit);
  const auto parameters = hypothesis.parameters();
  const std::size_t from = fit.x.size();
  const auto rows = static_cast<Eigen::Index>(model.observation_count());
  Eigen::MatrixXd columns(rows, static_cast<Eigen::Index>(parameters.size() - from));
  const std::vector<double> at = predicted.empty() ? hypothesis.predict(model, start)
                                                   : std::vector<double>(predicted.begin(), predicted.end());
  for (std::size_t p = from; p < parameters.size(); ++p) {
    const Parameter& parameter = parameters[p];
    std::vector<double> x = start;
    const double step = hypothesis.step(p);
    x[p] = x[p] + step <= parameter.highest ? x[p] + step : x[p] - step;
    const std::vector<double> changed = hypothesis.predict(model, x);
    const double scale = parameter.std / (x[p] - start[p]);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double slope = scale * (changed[static_cast<std::size_t>(i)] - at[static_cast<std::size_t>(i)]);
      columns(i, static_cast<Eigen::Index>(p - from)) = std::isfinite(slope) ? slope : 0.0;
    }
  }
  return columns;
}

Eigen::MatrixXd added_columns(const Hypothesis& hypothesis, const WindowModel& model, const NoiseModel& noise,
                              const FittedExplanation& fit, std::vector<double>& start) {
  return fit.row_weights.asDiagonal() * noise.whiten(added_derivatives(hypothesis, model, fit, start));
}

double size_of(const FittedExplanation& fit, std::string_view effect) {
  const auto parameters = fit.hypothesis.parameters();
  double size = 0.0;
  for (std::size_t p = fit.hypothesis.nuisance_count(); p < parameters.size(); ++p)
    if (parameters[p].effect == effect && !parameters[p].shape)
      size = std::max(size, std::abs(fit.x[p] - parameters[p].neutral) / parameters[p].std);
  return size;
}

Eigen::VectorXd measured(const WindowModel& model) {
  Eigen::VectorXd y(static_cast<Eigen::Index>(model.observation_count()));
  Eigen::Index i = 0;
  for (const DriveWindow& window : model.windows())
    for (const Observation& o : window.observations) y[i++] = o.value;
  return y;
}

void keep_better(FittedExplanation& fit, FittedExplanation other) {
  if (other.log_evidence > fit.log_evidence) fit = std::move(other);
}

FittedExplanation fit_explanation(const Hypothesis& hypothesis, const WindowModel& model,
                                  const NoiseModel& noise, const ModeStart& start, const FitOptions& options,
                                  std::size_t threads, const std::vector<bool>& fitted_rows,
                                  double must_reach) {
  const SimulatedDrives drives(hypothesis, model, noise, threads);
  if (leaves_open(model)) must_reach = kAnyEvidence;
  FittedExplanation fit{find_mode(drives, start, options, fitted_rows, must_reach), hypothesis};
  if (fit.unanswered > 0 && options.max_iterations > 0)
    if (const auto start_there = where_it_answers(drives, hypothesis, fit, options, fitted_rows))
      keep_better(fit, {find_mode(drives, *start_there, options, fitted_rows, must_reach), hypothesis});
  leave_open(model, noise, fit);
  return fit;
}

bool went_far(const FittedExplanation& fit, double max_shift) {
  const auto parameters = fit.hypothesis.parameters();
  for (std::size_t p = 0; p < fit.hypothesis.nuisance_count(); ++p)
    if (std::abs(fit.x[p] - parameters[p].neutral) > max_shift * parameters[p].std) return true;
  return false;
}

}  // namespace slipway::gap
