#include <ceres/ceres.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.h"
#include "gap/estimate/jacobian_svd.h"
#include "gap/estimate/least_squares.h"

namespace slipway::gap {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::vector<Fault> faults_of(std::span<const Unknown> unknowns, std::size_t residual_count,
                             const LeastSquaresOptions& options) {
  std::vector<Fault> faults;
  const auto positive = [&](const std::string& pointer, const char* name, double value) {
    if (!(value > 0.0 && std::isfinite(value)))
      faults.push_back({pointer, fmt::format("{} = {}, must be positive", name, value)});
  };
  if (unknowns.empty()) faults.push_back({"/unknowns", "there is nothing to estimate"});
  if (residual_count == 0) faults.push_back({"", "there are no residuals"});
  for (std::size_t k = 0; k < unknowns.size(); ++k) {
    const Unknown& u = unknowns[k];
    const std::string pointer = fmt::format("/unknowns/{}", k);
    positive(pointer + "/step_scale", "step_scale", u.step_scale);
    if (u.prior) positive(pointer + "/prior/std", "std", u.prior->std);
    if (!(u.lowest < u.highest))
      faults.push_back(
          {pointer + "/lowest", fmt::format("lowest = {}, must be below highest = {}", u.lowest, u.highest)});
    else if (!(std::isfinite(u.start) && u.start >= u.lowest && u.start <= u.highest))
      faults.push_back({pointer + "/start",
                        fmt::format("{} = {}, must be in [{}, {}]", u.name, u.start, u.lowest, u.highest)});
  }
  positive("/options/loss_scale", "loss_scale", options.loss_scale);
  positive("/options/tolerance", "tolerance", options.tolerance);
  positive("/options/relative_step", "relative_step", options.relative_step);
  positive("/options/rank_tolerance", "rank_tolerance", options.rank_tolerance);
  positive("/options/starts", "starts", options.starts);
  positive("/options/max_iterations", "max_iterations", options.max_iterations);
  return faults;
}

// The loss as a residual of its own, q with 1/2 q^2 = rho(r), so that one block holds all residuals; and its
// slope dq / dr.
struct Robust {
  double value, slope;
};
Robust robust(double r, const LeastSquaresOptions& options) {
  const double s = options.loss_scale, a = std::abs(r);
  if (options.loss == RobustLoss::kHuber && a > s) {
    const double q = std::sqrt(s * (2.0 * a - s));
    return {std::copysign(q, r), s / q};
  }
  if (options.loss == RobustLoss::kCauchy && a > 1e-6 * s) {
    const double x = (r / s) * (r / s), q = s * std::sqrt(std::log1p(x));
    return {std::copysign(q, r), a / ((1.0 + x) * q)};
  }
  return {r, 1.0};
}

// The slope of the loss in r, psi, and the slope of that.
struct Influence {
  double psi, slope;
};
Influence influence(double r, const LeastSquaresOptions& options) {
  const double s = options.loss_scale;
  if (options.loss == RobustLoss::kHuber && std::abs(r) > s) return {std::copysign(s, r), 0.0};
  if (options.loss == RobustLoss::kCauchy) {
    const double x = (r / s) * (r / s);
    return {r / (1.0 + x), (1.0 - x) / ((1.0 + x) * (1.0 + x))};
  }
  return {r, 1.0};
}

// Residuals and priors over y = x / step_scale, so that steps and tolerances do not depend on units.
class Problem final : public ceres::CostFunction {
 public:
  Problem(std::span<const Unknown> unknowns, std::size_t residual_count, const ResidualFunction& residuals,
          const LeastSquaresOptions& options, const Progress& progress)
      : unknowns_(unknowns),
        residuals_(residuals),
        options_(options),
        progress_(progress),
        data_(residual_count),
        x_(unknowns.size()),
        up_(residual_count),
        down_(residual_count) {
    std::size_t rows = residual_count;
    for (const Unknown& u : unknowns)
      if (u.prior) ++rows;
    set_num_residuals(static_cast<int>(rows));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(unknowns.size()));
  }

  bool Evaluate(double const* const* y, double* q, double** jacobians) const override {
    if (progress_.cancelled()) return nothing(q, jacobians);
    if (!at(y[0], data_)) return false;
    for (std::size_t i = 0; i < data_.size(); ++i) q[i] = robust(data_[i], options_).value;
    std::size_t row = data_.size();
    for (std::size_t k = 0; k < unknowns_.size(); ++k)
      if (const auto& prior = unknowns_[k].prior)
        q[row++] = (y[0][k] * unknowns_[k].step_scale - prior->mean) / prior->std;
    return jacobians == nullptr || jacobians[0] == nullptr || differentiate(y[0], jacobians[0]);
  }

  // The residuals of the data alone, before the loss.
  bool at(const double* y, std::vector<double>& residuals) const {
    for (std::size_t k = 0; k < x_.size(); ++k) x_[k] = value(k, y);
    return residuals_(x_, residuals) &&
           std::all_of(residuals.begin(), residuals.end(), [](double r) { return std::isfinite(r); });
  }

  // Of the unknown in the caller's unit; rounding does not carry it over a bound.
  double value(std::size_t k, const double* y) const {
    return std::clamp(y[k] * unknowns_[k].step_scale, unknowns_[k].lowest, unknowns_[k].highest);
  }
  double lowest(std::size_t k) const { return unknowns_[k].lowest / unknowns_[k].step_scale; }
  double highest(std::size_t k) const { return unknowns_[k].highest / unknowns_[k].step_scale; }

 private:
  // Central differences; towards the inside alone where a bound is nearer than the step.
  bool differentiate(const double* y, double* jacobian) const {
    const std::size_t n = unknowns_.size();
    Eigen::Map<Matrix> j(jacobian, num_residuals(), static_cast<Eigen::Index>(n));
    j.setZero();
    std::vector<double> moved(y, y + n);
    auto prior_row = static_cast<Eigen::Index>(data_.size());
    for (std::size_t k = 0; k < n && !progress_.cancelled(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      const double step = options_.relative_step * std::max(1.0, std::abs(y[k]));
      double high = std::min(y[k] + step, highest(k)), low = std::max(y[k] - step, lowest(k));
      if (!evaluate_moved(moved, k, high, up_)) {
        high = y[k];
        up_ = data_;
      }
      if (!evaluate_moved(moved, k, low, down_)) {
        low = y[k];
        down_ = data_;
      }
      moved[k] = y[k];
      if (!(high > low)) return false;
      for (std::size_t i = 0; i < data_.size(); ++i)
        j(static_cast<Eigen::Index>(i), column) =
            (up_[i] - down_[i]) / (high - low) * robust(data_[i], options_).slope;
      if (const auto& prior = unknowns_[k].prior)
        j(prior_row++, column) = unknowns_[k].step_scale / prior->std;
    }
    return true;
  }
  // What ends a search at once and without Ceres's log: once cancelled, nobody looks at the values.
  bool nothing(double* q, double** jacobians) const {
    std::fill_n(q, num_residuals(), 0.0);
    if (jacobians != nullptr && jacobians[0] != nullptr)
      std::fill_n(jacobians[0], static_cast<std::size_t>(num_residuals()) * unknowns_.size(), 0.0);
    return true;
  }
  bool evaluate_moved(std::vector<double>& moved, std::size_t k, double to, std::vector<double>& out) const {
    moved[k] = to;
    return at(moved.data(), out);
  }

  std::span<const Unknown> unknowns_;
  const ResidualFunction& residuals_;
  const LeastSquaresOptions& options_;
  const Progress& progress_;
  mutable std::vector<double> data_, x_, up_, down_;
};

class StopWhenCancelled final : public ceres::IterationCallback {
 public:
  explicit StopWhenCancelled(const Progress& progress) : progress_(progress) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return progress_.cancelled() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  const Progress& progress_;
};

// The start'th start, over step_scale; the 0th is the caller's.
std::vector<double> start_of(std::span<const Unknown> unknowns, std::uint64_t seed, int start) {
  std::vector<double> y;
  for (std::size_t k = 0; k < unknowns.size(); ++k) {
    const Unknown& u = unknowns[k];
    double x = u.start;
    const std::uint64_t key = random_key(seed, static_cast<std::uint64_t>(start));
    if (start > 0 && std::isfinite(u.lowest) && std::isfinite(u.highest))
      x = u.lowest + (u.highest - u.lowest) * random_uniform(key, k);
    else if (start > 0)
      x = std::clamp(u.start + u.step_scale * random_normal(key, k), u.lowest, u.highest);
    y.push_back(x / u.step_scale);
  }
  return y;
}

struct Search {
  std::vector<double> y;
  double cost = 0.0;
  bool converged = false;
  std::string message;
};

// The unknowns that lie on a bound and that the cost pushes against it.
std::vector<int> pressed_on_bounds(const Problem& cost_function, const std::vector<double>& y) {
  Matrix jacobian(cost_function.num_residuals(), static_cast<Eigen::Index>(y.size()));
  Eigen::VectorXd residuals(cost_function.num_residuals());
  const double* block = y.data();
  double* blocks[] = {jacobian.data()};
  std::vector<int> pressed;
  bool any = false;
  for (std::size_t k = 0; k < y.size(); ++k)
    any = any || y[k] <= cost_function.lowest(k) || y[k] >= cost_function.highest(k);
  if (!any) return pressed;
  if (!cost_function.Evaluate(&block, residuals.data(), blocks)) return pressed;
  const Eigen::VectorXd slope = jacobian.transpose() * residuals;
  for (std::size_t k = 0; k < y.size(); ++k) {
    const double uphill = slope[static_cast<Eigen::Index>(k)];
    if ((y[k] <= cost_function.lowest(k) && uphill > 0.0) ||
        (y[k] >= cost_function.highest(k) && uphill < 0.0))
      pressed.push_back(static_cast<int>(k));
  }
  return pressed;
}

// Levenberg-Marquardt from y with the unknowns of `held` left as they are.
ceres::Solver::Summary solve(Problem& cost_function, std::vector<double>& y, const std::vector<int>& held,
                             const LeastSquaresOptions& options, const Progress& progress) {
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  problem.AddResidualBlock(&cost_function, nullptr, y.data());
  for (std::size_t k = 0; k < y.size(); ++k) {
    const int index = static_cast<int>(k);
    if (std::isfinite(cost_function.lowest(k)))
      problem.SetParameterLowerBound(y.data(), index, cost_function.lowest(k));
    if (std::isfinite(cost_function.highest(k)))
      problem.SetParameterUpperBound(y.data(), index, cost_function.highest(k));
  }
  if (!held.empty())
    problem.SetManifold(y.data(), new ceres::SubsetManifold(static_cast<int>(y.size()), held));
  StopWhenCancelled stop(progress);
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.logging_type = ceres::SILENT;
  solver.num_threads = 1;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = options.tolerance;
  solver.parameter_tolerance = options.tolerance;
  solver.gradient_tolerance = 1e-4 * options.tolerance;
  solver.callbacks.push_back(&stop);
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  return summary;
}

// One search; nothing where the residuals have no value at its start. Ceres projects a whole step on the
// bounds, which can stop short along the free unknowns; so what is pressed on a bound is held there and the
// rest is searched again, until the same unknowns are pressed as were held.
std::optional<Search> search(Problem& cost_function, std::vector<double> y,
                             const LeastSquaresOptions& options, const Progress& progress) {
  std::vector<double> residuals(static_cast<std::size_t>(cost_function.num_residuals()));
  const double* block = y.data();
  if (!cost_function.Evaluate(&block, residuals.data(), nullptr)) return std::nullopt;
  std::vector<int> held;
  for (std::size_t round = 0;; ++round) {
    const ceres::Solver::Summary summary = solve(cost_function, y, held, options, progress);
    if (summary.termination_type == ceres::FAILURE || progress.cancelled()) return std::nullopt;
    const std::vector<int> pressed = pressed_on_bounds(cost_function, y);
    const bool settled = pressed == held || pressed.size() == y.size();
    if (settled || round > 2 * y.size())
      return Search{y, summary.final_cost, settled && summary.termination_type == ceres::CONVERGENCE,
                    summary.message};
    held = pressed;
  }
}

// LeastSquaresFit::residual_variance of residuals, of which the first `data` have the loss.
double variance_left_over(std::span<const double> through_loss, std::span<const double> data,
                          std::size_t unknowns, const LeastSquaresOptions& options) {
  if (through_loss.size() <= unknowns) return 0.0;
  double squares = 0.0, slopes = 0.0;
  for (const double r : data) {
    const Influence of = influence(r, options);
    squares += of.psi * of.psi;
    slopes += of.slope;
  }
  for (const double prior : through_loss.subspan(data.size())) squares += prior * prior;
  const auto count = static_cast<double>(data.size());
  // Where most residuals are beyond Cauchy's scale their slopes can sum to less than nothing.
  const double mean_slope = std::max(slopes / count, 1.0 / count);
  return squares / static_cast<double>(through_loss.size() - unknowns) / mean_slope;
}

// From the loss's own slopes, by which a search goes, to those by which the covariance does.
void weigh_for_covariance(std::span<const double> data, const LeastSquaresOptions& options,
                          Matrix& jacobian) {
  for (std::size_t i = 0; i < data.size(); ++i)
    jacobian.row(static_cast<Eigen::Index>(i)) *=
        std::sqrt(std::max(influence(data[i], options).slope, 0.0)) / robust(data[i], options).slope;
}

LeastSquaresFit conclude(const Search& best, std::span<const Unknown> unknowns, std::size_t residual_count,
                         const Problem& cost_function, const LeastSquaresOptions& options) {
  LeastSquaresFit fit;
  fit.cost = best.cost;
  fit.converged = best.converged;
  fit.message = best.message;
  fit.residuals.resize(residual_count);
  cost_function.at(best.y.data(), fit.residuals);
  const auto n = static_cast<Eigen::Index>(unknowns.size());
  Matrix jacobian = Matrix::Zero(cost_function.num_residuals(), n);
  std::vector<double> residuals(static_cast<std::size_t>(cost_function.num_residuals()));
  const double* y = best.y.data();
  double* blocks[] = {jacobian.data()};
  cost_function.Evaluate(&y, residuals.data(), options.covariance ? blocks : nullptr);
  Eigen::VectorXd scale(n);
  std::vector<std::string> names;
  for (std::size_t k = 0; k < unknowns.size(); ++k) {
    const Unknown& u = unknowns[k];
    const double x = cost_function.value(k, best.y.data());
    fit.estimate.push_back(x);
    fit.on_bound.push_back(best.y[k] <= cost_function.lowest(k) || best.y[k] >= cost_function.highest(k));
    jacobian.col(static_cast<Eigen::Index>(k)) /= u.step_scale;
    scale[static_cast<Eigen::Index>(k)] = std::max(u.step_scale, std::abs(x));
    names.push_back(u.name);
  }
  fit.residual_variance = variance_left_over(residuals, fit.residuals, unknowns.size(), options);
  if (!options.covariance) return fit;
  if (options.loss != RobustLoss::kNone) weigh_for_covariance(fit.residuals, options, jacobian);
  if (options.residual_std_known && options.widen && fit.residual_variance > 1.0)
    jacobian.topRows(static_cast<Eigen::Index>(residual_count)) /= std::sqrt(fit.residual_variance);
  JacobianSvd svd = covariance_by_svd(jacobian, scale, names, options.rank_tolerance);
  if (!options.residual_std_known) svd.covariance *= fit.residual_variance;
  fit.covariance = std::move(svd.covariance);
  fit.undetermined = std::move(svd.undetermined);
  return fit;
}

}  // namespace

std::span<const std::string_view> robust_loss_names() {
  static constexpr std::array<std::string_view, 3> kNames{"none", "huber", "cauchy"};
  return kNames;
}

double usual_loss_scale(RobustLoss loss) {
  if (loss == RobustLoss::kHuber) return 1.345;
  if (loss == RobustLoss::kCauchy) return 2.385;
  return 1.0;
}

std::optional<double> LeastSquaresFit::standard_error(std::size_t unknown) const {
  const auto k = static_cast<Eigen::Index>(unknown);
  for (const UndeterminedDirection& direction : undetermined)
    if (std::abs(direction.components[k]) > 1e-3) return std::nullopt;
  return std::sqrt(covariance(k, k));
}

std::optional<double> LeastSquaresFit::correlation(std::size_t a, std::size_t b) const {
  const double product = standard_error(a).value_or(0.0) * standard_error(b).value_or(0.0);
  if (!(product > 0.0)) return std::nullopt;
  return covariance(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) / product;
}

Result<LeastSquaresFit> fit_least_squares(std::span<const Unknown> unknowns, std::size_t residual_count,
                                          const ResidualFunction& residuals,
                                          const LeastSquaresOptions& options, Progress& progress) {
  if (auto faults = faults_of(unknowns, residual_count, options); !faults.empty())
    return fail(ErrorCode::kInvalidRequest, "the least-squares problem can't be posed", std::move(faults));
  Problem cost_function(unknowns, residual_count, residuals, options, progress);
  std::optional<Search> best;
  for (int start = 0; start < options.starts; ++start) {
    progress.report("fitting", static_cast<double>(start) / options.starts);
    auto found = search(cost_function, start_of(unknowns, options.seed, start), options, progress);
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the fit was given up");
    if (found && (!best || found->cost < best->cost)) best = std::move(found);
  }
  if (!best)
    return fail(ErrorCode::kNotConverged, "the residuals have no value at any start or no slope there");
  LeastSquaresFit fit = conclude(*best, unknowns, residual_count, cost_function, options);
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the fit was given up");
  return fit;
}

}  // namespace slipway::gap
