#include "gap/estimate/soil_estimation.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "core/normal_interval.h"
#include "gap/estimate/jacobian_svd.h"
#include "gap/estimate/soil_posterior.h"
#include "gap/estimate/soil_profile.h"
#include "gap/estimate/soil_search.h"

namespace slipway::gap {
namespace {

// What is searched for the free parameters: k_phi follows from k and k_c.
std::vector<FreeParameter> axes_of(const std::vector<FreeParameter>& free) {
  std::vector<FreeParameter> axes;
  for (const FreeParameter& parameter : free)
    if (parameter.soil == SoilParameter::kKphi) {
      axes.emplace_back(SoilParameter::kBekker);
      axes.back().of = parameter.of;
    }
  for (const FreeParameter& parameter : free)
    if (parameter.soil != SoilParameter::kKphi) axes.push_back(parameter);
  return axes;
}

class Estimation {
 public:
  Estimation(std::span<const sim::SoilDistribution> nominals, const SoilData& data,
             std::vector<FreeParameter> free, const SoilEstimationOptions& options, Progress& progress)
      : nominals_(nominals),
        data_(data),
        free_(std::move(free)),
        options_(options),
        progress_(progress),
        within_(progress),
        observations_(data, options.noise, options.channels),
        search_(data, nominals, axes_of(free_), options, observations_) {
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
    auto fit = search_.fit(fit_options_, progress_);
    if (!fit) return fail(fit.error());
    fit_ = std::move(*fit);
    describe_fit();
    describe_soils();
    describe_open_directions();
    if (const auto described = describe_parameters(); !described) return fail(described.error());
    estimate_.evaluations = observations_.evaluations();
    return std::move(estimate_);
  }

 private:
  const TestedRigs& rigs() const { return search_.rigs(); }

  void describe_fit() {
    SoilEstimate& e = estimate_;
    const auto data = observations_.data();
    std::vector<double> fitted(data.size());
    search_.predict(fit_.estimate, fitted);
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
    const std::size_t known = data.size() + search_.priors(), searched = search_.unknowns().size();
    e.max_residual_variance =
        max_residual_variance(known > searched ? known - searched : 0, options_.determination);
    e.model_holds = e.residual_variance <= e.max_residual_variance;
    e.converged = fit_.converged;
    e.sunk = observations_.sunk();
    note_fit();
  }

  void note_fit() {
    SoilEstimate& e = estimate_;
    if (e.sunk > 0)
      e.notes.push_back(fmt::format("{} of the wheels would sink to the axle in this soil", e.sunk));
    if (!e.converged) e.notes.push_back("the search did not converge: " + fit_.message);
    if (!e.model_holds || e.residual_variance > 2.0)
      e.notes.push_back(fmt::format(
          "the readings scatter {:.1f} times as much as their deviations say: the model does not hold there, "
          "or the noise is greater; deviations and intervals are widened by as much",
          std::sqrt(e.residual_variance)));
    if (holds(free_, SoilParameter::kKc) && observations_.one_width())
      e.notes.push_back(
          "all wheels and plates have one width: only k_c / b + k_phi can be determined, not k_c and "
          "k_phi apart; k_bekker in their place is better");
  }

  void describe_soils() {
    for (std::size_t s = 0; s < nominals_.size(); ++s) {
      sim::SoilDistribution soil = posterior_soil(nominals_[s], rigs().soil_at(s, fit_.estimate),
                                                  rigs().soil_axes(s), rigs().places(s), fit_);
      for (std::size_t k = 0; k < rigs().axes().size(); ++k) {
        const auto error = fit_.standard_error(k);
        if (!error || !rigs().applies_to_soil(k, s)) continue;
        // Draws of c1 and c2 are log-normal, in [0, 1].
        if (rigs().axes()[k].name == "c1" && soil.mean.c1 > 0.0) soil.std.c1 = std::min(*error, 1.0);
        if (rigs().axes()[k].name == "c2" && soil.mean.c2 > 0.0) soil.std.c2 = std::min(*error, 1.0);
      }
      (s == 0 ? estimate_.soil : estimate_.further_soils.emplace_back()) = std::move(soil);
    }
  }

  // Of the data alone, columns counted in what soils of all kinds differ by.
  void describe_open_directions() {
    const ResidualFunction residuals = search_.residuals();
    const auto rows = static_cast<Eigen::Index>(readings());
    const auto n = static_cast<Eigen::Index>(search_.unknowns().size());
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows, n);
    Eigen::VectorXd scale(n);
    std::vector<double> up(readings()), down(readings());
    std::vector<std::string> names;
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      scale[k] = rigs().wide_std(axis);
      const Unknown& u = search_.unknowns()[axis];
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

  // Of the free parameters' coordinates by the axes': k_phi = k - k_c / b.
  Eigen::MatrixXd free_by_axes() const {
    const auto n = static_cast<Eigen::Index>(free_.size());
    const auto size = static_cast<Eigen::Index>(search_.unknowns().size());
    Eigen::MatrixXd by_axes = Eigen::MatrixXd::Zero(n, size);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index k = 0; k < size; ++k) {
        const FreeParameter& free = free_[static_cast<std::size_t>(i)];
        const FreeParameter& axis = rigs().axes()[static_cast<std::size_t>(k)];
        if (free == axis) by_axes(i, k) = 1.0;
        if (free.soil != SoilParameter::kKphi || free.of != axis.of) continue;
        if (axis.soil == SoilParameter::kBekker)
          by_axes(i, k) = rigs().value_at(static_cast<std::size_t>(k), fit_.estimate);
        if (axis.soil == SoilParameter::kKc) by_axes(i, k) = -1.0 / observations_.width_m();
      }
    return by_axes;
  }

  Result<bool> describe_parameters() {
    const auto n = static_cast<Eigen::Index>(free_.size());
    const Eigen::MatrixXd by_axes = free_by_axes();
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
  Result<EstimatedParameter> describe(const FreeParameter& parameter, std::optional<double> deviation) {
    EstimatedParameter p;
    p.parameter = parameter;
    // k_phi in the place of k_c.
    std::vector<FreeParameter> axes(rigs().axes().begin(), rigs().axes().end());
    FreeParameter place = parameter;
    if (parameter.soil == SoilParameter::kKphi) {
      place = SoilParameter::kKc;
      place.of = parameter.of;
    }
    const auto at = static_cast<std::size_t>(std::find(axes.begin(), axes.end(), place) - axes.begin());
    axes[at] = parameter;
    const SoilSearch search(data_, nominals_, axes, options_, observations_);
    std::vector<double> around = fit_.estimate, start;
    for (const Unknown& u : search.unknowns()) start.push_back(u.start);
    if (!(place == parameter)) {
      const double width_m = observations_.width_m();
      const sim::Soil soil = rigs().soil_at(*rigs().soil_of(at), fit_.estimate);
      around[at] = value_of(SoilParameter::kKphi, soil, width_m);
    }
    p.start = search.rigs().value_at(at, start);
    p.value = search.rigs().value_at(at, around);
    if (deviation) p.std = search.rigs().value_std(at, around, *deviation);
    const std::optional<double> prior = search.prior_std(at);
    if (prior) p.prior_std = search.rigs().value_std(at, start, *prior);
    const Unknown& unknown = search.unknowns()[at];
    p.on_bound = around[at] <= unknown.lowest || around[at] >= unknown.highest;
    // What the data alone say, where the prior has a part in the posterior.
    double alone = deviation.value_or(unknown.step_scale);
    if (prior && alone < *prior) alone /= std::sqrt(std::max(1.0 - std::pow(alone / *prior, 2), 0.01));
    const auto range = range_of(search, at, around, alone);
    if (!range) return fail(range.error());
    p.low = range->low;
    p.high = range->high;
    p.low_open = range->low_open;
    p.high_open = range->high_open;
    const DeterminationGrounds grounds{
        .says_more = deviation && (!prior || *deviation < options_.determination.max_of_prior * *prior),
        .model_holds = estimate_.model_holds,
        .spare_readings = readings() > free_.size() ? readings() - free_.size() : 0,
        .scale = compared_with(search.rigs(), at, p.value)};
    if (options_.profile &&
        said_by(*range, p.value, grounds, options_.determination) != Determination::kUndetermined)
      if (const auto done = let_assumptions_vary(axes, at, around, alone, p); !done)
        return fail(done.error());
    judge(p, grounds, options_.determination);
    return p;
  }

  // What the width of an interval is compared with. A modulus that may be negative is measured by the
  // stiffness, a number with 0 in its range by what it differs by among soils, at least.
  static std::optional<double> compared_with(const TestedRigs& rigs, std::size_t axis, double value) {
    const FreeParameter& parameter = rigs.axes()[axis];
    if (parameter.soil == SoilParameter::kKc || parameter.soil == SoilParameter::kKphi)
      return rigs.scale(axis);
    if (parameter.soil || parameter.field.lowest > 0.0) return std::nullopt;
    return std::max(std::abs(value), rigs.wide_std(axis));
  }

  // `alone`: a guess of the coordinate's deviation.
  Result<ParameterRange> range_of(const SoilSearch& search, std::size_t at, const std::vector<double>& around,
                                  double alone) {
    const std::span<const Unknown> unknowns = search.unknowns();
    ProfileInterval interval;
    if (options_.profile) {
      ProfileOptions profile{.fit = fit_options_};
      profile.rise *= std::max(1.0, fit_.residual_variance);
      profile.fit.tolerance = 1e-5;
      profile.fit.max_iterations = 15;
      profile.fit.covariance = false;
      const auto found =
          profile_interval(unknowns, at, readings(), search.residuals(), around, alone, profile, within_);
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
      return search.rigs().value_at(at, x);
    };
    return ParameterRange{value_at(interval.low), value_at(interval.high), interval.low_open,
                          interval.high_open};
  }

  // The range once more with what is neither free nor stated free too, within its uncertainty.
  Result<bool> let_assumptions_vary(std::vector<FreeParameter> axes, std::size_t at,
                                    std::vector<double> around, double alone, EstimatedParameter& p) {
    const std::vector<Assumed> assumed =
        assumed_of(data_, nominals_, observations_.width_m(), free_, options_);
    if (assumed.empty()) return true;
    for (const Assumed& one : assumed) axes.push_back(one.parameter);
    // Priors are of what is assumed alone, each with its own deviation.
    std::vector<double> deviations(around.size(), 0.0);
    for (const Assumed& one : assumed) deviations.push_back(one.std);
    const SoilSearch search(data_, nominals_, std::move(axes), options_, observations_, deviations);
    for (std::size_t k = around.size(); k < search.unknowns().size(); ++k)
      around.push_back(search.unknowns()[k].start);
    const auto range = range_of(search, at, around, alone);
    if (!range) return fail(range.error());
    p.with_assumed = *range;
    for (const Assumed& one : assumed) p.assumed.push_back(one.parameter.shown());
    return true;
  }

  std::span<const sim::SoilDistribution> nominals_;
  const SoilData& data_;
  std::vector<FreeParameter> free_;
  const SoilEstimationOptions& options_;
  Progress& progress_;
  Within within_;
  SoilObservations observations_;
  SoilSearch search_;
  LeastSquaresOptions fit_options_;
  LeastSquaresFit fit_;
  SoilEstimate estimate_;
};

}  // namespace

Result<SoilEstimate> estimate_soils(std::span<const sim::SoilDistribution> nominals, const SoilData& data,
                                    const SoilEstimationOptions& options, Progress& progress) {
  if (data.wheels.empty() && data.plates.empty())
    return fail(ErrorCode::kNoData, "there are no tests to estimate a soil from");
  const std::vector<FreeParameter> free = options.free.empty() ? usual_free_parameters(data) : options.free;
  if (auto faults = faults_of(free, data, options); !faults.empty())
    return fail(ErrorCode::kInvalidRequest, "the soil can't be estimated so", std::move(faults));
  Estimation estimation(nominals, data, free, options, progress);
  if (estimation.readings() < options.min_readings)
    return fail(ErrorCode::kNoData,
                fmt::format("{} readings are too few to estimate a soil from", estimation.readings()));
  return estimation.run();
}

Result<SoilEstimate> estimate_soil(const sim::SoilDistribution& nominal, const SoilData& data,
                                   const SoilEstimationOptions& options, Progress& progress) {
  return estimate_soils(std::span(&nominal, 1), data, options, progress);
}

}  // namespace slipway::gap
