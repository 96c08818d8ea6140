#include "gap/estimate/soil_estimation.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "core/normal_interval.h"
#include "core/random.h"
#include "gap/estimate/jacobian_svd.h"
#include "gap/estimate/soil_posterior.h"
#include "gap/estimate/soil_profile.h"

namespace slipway::gap {
namespace {

// Searches within a search: heard when it is given up, but not reported.
class Within final : public Progress {
 public:
  explicit Within(const Progress& outer) : outer_(outer) {}
  void report(std::string_view /*stage*/, double /*fraction*/) override {}
  bool cancelled() const override { return outer_.cancelled(); }

 private:
  const Progress& outer_;
};

// What is searched for the free parameters: k_phi follows from k and k_c.
std::vector<SoilParameter> axes_of(const std::vector<SoilParameter>& free) {
  std::vector<SoilParameter> axes;
  if (holds(free, SoilParameter::kKphi)) axes.push_back(SoilParameter::kBekker);
  for (const SoilParameter parameter : free)
    if (parameter != SoilParameter::kKphi) axes.push_back(parameter);
  return axes;
}

class Estimation {
 public:
  Estimation(const sim::SoilDistribution& nominal, const SoilData& data, std::vector<SoilParameter> free,
             const SoilEstimationOptions& options, Progress& progress)
      : nominal_(nominal),
        free_(std::move(free)),
        options_(options),
        progress_(progress),
        within_(progress),
        observations_(data, options.noise, options.channels),
        axes_(nominal.mean, observations_.width_m(), axes_of(free_)) {
    for (const SoilParameter axis : axes_.axes()) unknowns_.push_back(unknown_of(axis));
    fit_options_.loss = options.loss;
    fit_options_.loss_scale = options.loss_scale.value_or(usual_loss_scale(options.loss));
    fit_options_.widen = true;
    fit_options_.seed = options.seed;
    fit_options_.max_iterations = 60;
    fit_options_.tolerance = 1e-9;
  }

  std::size_t readings() const { return observations_.data().size(); }

  Result<SoilEstimate> run() {
    progress_.report("fitting the soil", 0.0);
    auto fit = search();
    if (!fit) return fail(fit.error());
    fit_ = std::move(*fit);
    describe_fit();
    describe_open_directions();
    if (const auto described = describe_parameters(); !described) return fail(described.error());
    estimate_.evaluations = observations_.evaluations();
    return std::move(estimate_);
  }

 private:
  Unknown unknown_of(SoilParameter axis) const {
    const SoilParameterRow& row = row_of(axis);
    const double scale = axes_.scale(axis);
    Unknown u;
    u.name = row.name;
    u.step_scale = scale;
    u.start = axes_.coordinate(axis, nominal_.mean);
    double lowest = row.lowest, highest = row.highest;
    if (axis == SoilParameter::kBekker) {
      lowest *= axes_.base().pressure.stiffness(axes_.width_m());
      highest *= axes_.base().pressure.stiffness(axes_.width_m());
    } else if (axis == SoilParameter::kKc || axis == SoilParameter::kKphi) {
      lowest *= scale;
      highest *= scale;
    }
    for (const SoilBound& bound : options_.bounds)
      if (bound.parameter == axis) {
        lowest = bound.lowest;
        highest = bound.highest;
      }
    u.lowest = axes_.coordinate_of_value(axis, lowest);
    u.highest = axes_.coordinate_of_value(axis, highest);
    u.start = std::clamp(u.start, u.lowest, u.highest);
    if (const auto std = prior_std(axis)) u.prior = Prior{u.start, *std};
    return u;
  }

  // Of a coordinate.
  double wide_std(SoilParameter axis) const {
    const bool modulus = axis == SoilParameter::kKc || axis == SoilParameter::kKphi;
    return row_of(axis).wide_std * (modulus ? axes_.scale(axis) : 1.0);
  }
  std::optional<double> prior_std(SoilParameter axis) const {
    if (options_.priors == SoilPriors::kNone) return std::nullopt;
    const double own = options_.priors == SoilPriors::kSoil ? coordinate_std(nominal_, axis, axes_) : 0.0;
    return own > 0.0 ? own : wide_std(axis);
  }

  ResidualFunction residuals_of(const SoilAxes& axes) {
    return [this, axes](std::span<const double> x, std::span<double> r) {
      if (!observations_.predict(axes.soil_at(x), r)) return false;
      const auto data = observations_.data();
      for (std::size_t i = 0; i < data.size(); ++i) r[i] = (r[i] - data[i].measured) / data[i].std;
      return true;
    };
  }

  // From elsewhere: what soils of all kinds differ by, half of it, and where n is another, k so that the
  // pressure at a usual depth is the same.
  std::vector<Unknown> drawn_start(int start) const {
    std::vector<Unknown> moved = unknowns_;
    double exponent_change = 0.0;
    for (std::size_t k = 0; k < moved.size(); ++k) {
      const SoilParameter axis = axes_.axes()[k];
      const double change = options_.start_share * wide_std(axis) *
                            random_normal(random_key(options_.seed, static_cast<std::uint64_t>(start)), k);
      if (axis == SoilParameter::kN)
        exponent_change = nominal_.mean.pressure.n * (std::exp(moved[k].start + change) - 1.0);
      moved[k].start += change;
    }
    for (std::size_t k = 0; k < moved.size(); ++k) {
      if (axes_.axes()[k] == SoilParameter::kBekker)
        moved[k].start -= exponent_change * std::log(options_.usual_depth_m);
      moved[k].start = std::clamp(moved[k].start, moved[k].lowest, moved[k].highest);
    }
    return moved;
  }

  Result<LeastSquaresFit> search() {
    const ResidualFunction residuals = residuals_of(axes_);
    auto best = fit_least_squares(unknowns_, readings(), residuals, fit_options_, within_);
    const auto is_poor = [&](const Result<LeastSquaresFit>& fit) {
      return !fit || !fit->converged || fit->residual_variance > options_.poor_variance;
    };
    for (int start = 1; start <= options_.further_starts && is_poor(best); ++start) {
      if (progress_.cancelled()) break;
      const std::vector<Unknown> moved = drawn_start(start);
      auto fit = fit_least_squares(moved, readings(), residuals, fit_options_, within_);
      if (fit && (!best || fit->cost < best->cost)) best = std::move(fit);
    }
    return best;
  }

  void describe_fit() {
    SoilEstimate& e = estimate_;
    const auto data = observations_.data();
    std::vector<double> fitted(data.size());
    const sim::Soil soil = axes_.soil_at(fit_.estimate);
    observations_.predict(soil, fitted);
    std::array<double, kSoilChannels> squares{}, deviations{}, counts{};
    for (std::size_t i = 0; i < data.size(); ++i) {
      const auto c = static_cast<std::size_t>(data[i].channel);
      const double left = fitted[i] - data[i].measured;
      squares[c] += left * left;
      deviations[c] += left / data[i].std * (left / data[i].std);
      counts[c] += 1.0;
      const bool beyond = options_.loss != RobustLoss::kNone &&
                          std::abs(left / data[i].std) > options_.outlier_scales * fit_options_.loss_scale;
      e.data.push_back({data[i], fitted[i], beyond});
    }
    for (std::size_t c = 0; c < counts.size(); ++c)
      if (counts[c] > 0.0)
        e.channels.push_back({static_cast<SoilChannel>(c), static_cast<std::size_t>(counts[c]),
                              std::sqrt(squares[c] / counts[c]), std::sqrt(deviations[c] / counts[c])});
    e.width_m = observations_.width_m();
    e.residual_variance = fit_.residual_variance;
    e.converged = fit_.converged;
    e.sunk = observations_.sunk();
    e.soil = posterior_soil(nominal_, axes_, fit_);
    if (e.sunk > 0)
      e.notes.push_back(fmt::format("{} of the wheels would sink to the axle in this soil", e.sunk));
    if (!e.converged) e.notes.push_back("the search did not converge: " + fit_.message);
    if (e.residual_variance > 2.0)
      e.notes.push_back(fmt::format(
          "the readings scatter {:.1f} times as much as their deviations say: the model does not hold there, "
          "or the noise is greater; deviations and intervals are widened by as much",
          std::sqrt(e.residual_variance)));
    if (holds(free_, SoilParameter::kKc) && observations_.one_width())
      e.notes.push_back(
          "all wheels and plates have one width: only k_c / b + k_phi can be determined, not k_c and "
          "k_phi apart; k_bekker in their place is better");
  }

  // Of the data alone, columns counted in what soils of all kinds differ by.
  void describe_open_directions() {
    const ResidualFunction residuals = residuals_of(axes_);
    const auto rows = static_cast<Eigen::Index>(readings());
    const auto n = static_cast<Eigen::Index>(unknowns_.size());
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows, n);
    Eigen::VectorXd scale(n);
    std::vector<double> up(readings()), down(readings());
    std::vector<std::string> names;
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      scale[k] = wide_std(axes_.axes()[axis]);
      const Unknown& u = unknowns_[axis];
      names.push_back(u.name);
      constexpr double kStep = 1e-4;
      std::vector<double> x = fit_.estimate;
      const double high = std::min(x[axis] + kStep * u.step_scale, u.highest),
                   low = std::max(x[axis] - kStep * u.step_scale, u.lowest);
      x[axis] = high;
      if (!residuals(x, up)) continue;
      x[axis] = low;
      if (!residuals(x, down)) continue;
      for (Eigen::Index i = 0; i < rows; ++i)
        jacobian(i, k) = (up[static_cast<std::size_t>(i)] - down[static_cast<std::size_t>(i)]) / (high - low);
    }
    jacobian /= std::sqrt(std::max(1.0, fit_.residual_variance));
    const double largest =
        Eigen::JacobiSVD<Eigen::MatrixXd>(jacobian * scale.asDiagonal()).singularValues()[0];
    if (!(largest > 0.0)) return;
    // A singular value of 1: the data say as much as is known of soils of all kinds.
    for (const UndeterminedDirection& open :
         covariance_by_svd(jacobian, scale, names, std::min(1.0, 1.0 / largest)).undetermined)
      estimate_.open.push_back({open.words, open.singular_value * largest});
  }

  Result<bool> describe_parameters() {
    const auto n = static_cast<Eigen::Index>(free_.size());
    const auto size = static_cast<Eigen::Index>(unknowns_.size());
    // Of the free parameters' coordinates by the axes': k_phi = k - k_c / b.
    Eigen::MatrixXd by_axes = Eigen::MatrixXd::Zero(n, size);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index k = 0; k < size; ++k) {
        const SoilParameter free = free_[static_cast<std::size_t>(i)];
        const SoilParameter axis = axes_.axes()[static_cast<std::size_t>(k)];
        if (free == axis) by_axes(i, k) = 1.0;
        if (free != SoilParameter::kKphi) continue;
        if (axis == SoilParameter::kBekker)
          by_axes(i, k) = estimate_.soil.mean.pressure.stiffness(axes_.width_m());
        if (axis == SoilParameter::kKc) by_axes(i, k) = -1.0 / axes_.width_m();
      }
    const Eigen::MatrixXd covariance = by_axes * fit_.covariance * by_axes.transpose();
    const Eigen::VectorXd deviation = covariance.diagonal().cwiseMax(1e-300).cwiseSqrt();
    estimate_.correlation =
        deviation.cwiseInverse().asDiagonal() * covariance * deviation.cwiseInverse().asDiagonal();
    // Of what is not determined nothing is known.
    estimate_.correlation = estimate_.correlation.cwiseMax(-1.0).cwiseMin(1.0);
    for (Eigen::Index i = 0; i < n; ++i) {
      estimate_.correlation(i, i) = 1.0;
      progress_.report("profile likelihood", static_cast<double>(i + 1) / static_cast<double>(n + 1));
      bool open = false;
      for (const UndeterminedDirection& direction : fit_.undetermined)
        open = open || (by_axes.row(i) * direction.components)
                               .cwiseQuotient(by_axes.row(i).cwiseAbs().rowwise().sum())
                               .norm() > 1e-3;
      const auto p = describe(free_[static_cast<std::size_t>(i)],
                              open ? std::nullopt : std::optional<double>(deviation[i]));
      if (!p) return fail(p.error());
      estimate_.parameters.push_back(*p);
    }
    return true;
  }

  // `deviation`: posterior, of the coordinate.
  Result<EstimatedParameter> describe(SoilParameter parameter, std::optional<double> deviation) {
    EstimatedParameter p;
    p.parameter = parameter;
    const sim::Soil& soil = estimate_.soil.mean;
    p.start = value_of(parameter, nominal_.mean, axes_.width_m());
    p.value = value_of(parameter, soil, axes_.width_m());
    if (deviation) p.std = axes_.value_std(parameter, soil, *deviation);
    std::optional<double> prior = prior_std(parameter);
    if (prior) p.prior_std = axes_.value_std(parameter, nominal_.mean, *prior);
    // k_phi in the place of k_c.
    std::vector<SoilParameter> axes(axes_.axes().begin(), axes_.axes().end());
    std::vector<Unknown> unknowns = unknowns_;
    std::vector<double> around = fit_.estimate;
    std::size_t at = static_cast<std::size_t>(std::find(axes.begin(), axes.end(), parameter) - axes.begin());
    if (parameter == SoilParameter::kKphi) {
      at = static_cast<std::size_t>(std::find(axes.begin(), axes.end(), SoilParameter::kKc) - axes.begin());
      axes[at] = parameter;
      unknowns[at] = unknown_of(parameter);
      around[at] = soil.pressure.k_phi;
    }
    const SoilAxes searched(nominal_.mean, axes_.width_m(), axes);
    p.on_bound = around[at] <= unknowns[at].lowest || around[at] >= unknowns[at].highest;
    // What the data alone say, where the prior has a part in the posterior.
    double alone = deviation.value_or(unknowns[at].step_scale);
    if (prior && alone < *prior) alone /= std::sqrt(std::max(1.0 - std::pow(alone / *prior, 2), 0.01));
    ProfileInterval interval;
    if (options_.profile) {
      const ResidualFunction residuals = residuals_of(searched);
      ProfileOptions profile{.fit = fit_options_};
      profile.rise *= std::max(1.0, fit_.residual_variance);
      profile.fit.tolerance = 1e-5;
      profile.fit.max_iterations = 15;
      profile.fit.covariance = false;
      const auto found =
          profile_interval(unknowns, at, readings(), residuals, around, alone, profile, within_);
      if (!found) return fail(found.error());
      interval = *found;
    } else {
      interval.low = std::max(unknowns[at].lowest, around[at] - kReach90 * alone);
      interval.high = std::min(unknowns[at].highest, around[at] + kReach90 * alone);
      interval.low_open = interval.low <= unknowns[at].lowest;
      interval.high_open = interval.high >= unknowns[at].highest;
    }
    const auto value_at = [&](double coordinate) {
      std::vector<double> x = around;
      x[at] = coordinate;
      return value_of(parameter, searched.soil_at(x), axes_.width_m());
    };
    p.low = value_at(interval.low);
    p.high = value_at(interval.high);
    p.low_open = interval.low_open;
    p.high_open = interval.high_open;
    // A modulus that may be negative is measured by the stiffness.
    const bool modulus = parameter == SoilParameter::kKc || parameter == SoilParameter::kKphi;
    judge(p,
          {.says_more = deviation && (!prior || *deviation < options_.determination.max_of_prior * *prior),
           .residual_variance = fit_.residual_variance,
           .scale = modulus ? std::optional(axes_.scale(parameter)) : std::nullopt},
          options_.determination);
    return p;
  }

  const sim::SoilDistribution& nominal_;
  std::vector<SoilParameter> free_;
  const SoilEstimationOptions& options_;
  Progress& progress_;
  Within within_;
  SoilObservations observations_;
  SoilAxes axes_;
  std::vector<Unknown> unknowns_;
  LeastSquaresOptions fit_options_;
  LeastSquaresFit fit_;
  SoilEstimate estimate_;
};

}  // namespace

Result<SoilEstimate> estimate_soil(const sim::SoilDistribution& nominal, const SoilData& data,
                                   const SoilEstimationOptions& options, Progress& progress) {
  if (data.wheels.empty() && data.plates.empty())
    return fail(ErrorCode::kNoData, "there are no tests to estimate a soil from");
  const std::vector<SoilParameter> free = options.free.empty() ? usual_free_parameters(data) : options.free;
  if (auto faults = faults_of(free, options); !faults.empty())
    return fail(ErrorCode::kInvalidRequest, "the soil can't be estimated so", std::move(faults));
  for (std::size_t i = 0; i < data.wheels.size(); ++i)
    if (data.wheels[i][SoilChannel::kCurrent].value && !data.wheels[i].test.drive)
      return fail(ErrorCode::kInvalidRequest, "a measured current needs the motor that it was measured at");
  Estimation estimation(nominal, data, free, options, progress);
  if (estimation.readings() < options.min_readings)
    return fail(ErrorCode::kNoData,
                fmt::format("{} readings are too few to estimate a soil from", estimation.readings()));
  return estimation.run();
}

}  // namespace slipway::gap
