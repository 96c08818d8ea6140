#include "gap/estimate/soil_belief.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/normal_interval.h"
#include "core/quantile.h"
#include "core/random.h"
#include "gap/estimate/soil_search.h"

namespace slipway::gap {
namespace {

constexpr double kFlat = 1e6;             // deviation of a prior that says nothing between any bounds
constexpr Eigen::Index kPredicted = 200;  // soils for which readings are predicted

// What is normal between soils: a coordinate of the search but for where its zero lies.
bool by_logarithm(const FreeParameter& parameter) {
  if (parameter.soil) return *parameter.soil != SoilParameter::kCohesion;
  return parameter.field.lowest > 0.0 && parameter.field.highest >= 1000.0 * parameter.field.lowest;
}

double number_of(const FreeParameter& parameter, double value) {
  if (parameter.soil == SoilParameter::kFrictionAngle) return std::log(std::tan(value));
  return by_logarithm(parameter) ? std::log(value) : value;
}

double value_of_number(const FreeParameter& parameter, double number) {
  if (parameter.soil == SoilParameter::kFrictionAngle) return std::atan(std::exp(number));
  return by_logarithm(parameter) ? std::exp(number) : number;
}

// The tests of one soil and the search in them.
class SoilTests {
 public:
  SoilTests(const TestedSoilData& soil, const SoilBeliefOptions& options)
      : between_(options.between),
        observations_(soil.data, soil.options.noise, soil.options.channels),
        search_(soil.data, std::span(&soil.nominal, 1), soil.options.free, soil.options, observations_,
                deviations_of(soil, options.between)) {
    for (const FreeParameter& number : between_) {
      const auto& axes = soil.options.free;
      places_.push_back(static_cast<std::size_t>(std::find(axes.begin(), axes.end(), number) - axes.begin()));
    }
  }

  std::size_t readings() const { return observations_.data().size(); }

  // The numbers of the hierarchy at a point of the search.
  double number(std::size_t k, std::span<const double> x) const {
    return number_of(between_[k], search_.rigs().value_at(places_[k], x));
  }

  BetweenNumber bounds(std::size_t k, std::optional<double> usual_spread) const {
    std::vector<double> x = start();
    const Unknown& unknown = search_.unknowns()[places_[k]];
    BetweenNumber out{.usual_spread = usual_spread.value_or(search_.rigs().wide_std(places_[k]))};
    x[places_[k]] = unknown.lowest;
    out.lowest = number(k, x);
    x[places_[k]] = unknown.highest;
    out.highest = number(k, x);
    return out;
  }

  Result<LeastSquaresFit> fit(std::uint64_t seed, Progress& progress) const {
    LeastSquaresOptions options{.seed = seed, .max_iterations = 60, .tolerance = 1e-8};
    options.widen = true;
    return search_.fit(options, progress);
  }

  // Where residuals scatter more than their deviations, they count that much less, as in an estimate.
  LogDensity density(double variance) {
    return [this, variance,
            residuals = search_.residuals()](std::span<const double> x) -> std::optional<double> {
      double cost = 0.0;
      for (std::size_t k = 0; k < x.size(); ++k) {
        const Unknown& u = search_.unknowns()[k];
        if (x[k] < u.lowest || x[k] > u.highest) return std::nullopt;
        if (u.prior) cost += std::pow((x[k] - u.prior->mean) / u.prior->std, 2);
      }
      left_.resize(readings());
      if (!residuals(x, left_)) return std::nullopt;
      double squares = 0.0;
      for (const double r : left_) squares += r * r;
      return -0.5 * (cost + squares / variance);
    };
  }

  // Walkers around the best fit, as far apart as the fit is sure of each unknown.
  Eigen::MatrixXd starts(const LeastSquaresFit& fit, const EnsembleOptions& options) const {
    const auto unknowns = search_.unknowns();
    Eigen::MatrixXd x(static_cast<Eigen::Index>(options.walkers), static_cast<Eigen::Index>(unknowns.size()));
    for (Eigen::Index w = 0; w < x.rows(); ++w)
      for (std::size_t k = 0; k < unknowns.size(); ++k) {
        constexpr double kShare = 0.3;
        const Unknown& u = unknowns[k];
        const double apart =
            std::min(fit.standard_error(k).value_or(u.step_scale), 0.5 * search_.rigs().wide_std(k));
        const double z = random_normal(random_key(options.seed, static_cast<std::uint64_t>(w)), k);
        // Where a bound cuts it, on the other side.
        double at = fit.estimate[k] + kShare * apart * z;
        if (at < u.lowest || at > u.highest) at = fit.estimate[k] - kShare * apart * z;
        x(w, static_cast<Eigen::Index>(k)) = std::clamp(at, u.lowest, u.highest);
      }
    return x;
  }

  std::vector<double> start() const {
    std::vector<double> x;
    for (const Unknown& u : search_.unknowns()) x.push_back(u.start);
    return x;
  }

  // Readings in the 90 % interval of what these numbers, a row each, predict.
  std::size_t held(const Eigen::MatrixXd& numbers) const {
    std::vector<std::vector<double>> predicted(readings());
    std::vector<double> x = start(), values(readings());
    for (Eigen::Index row = 0; row < numbers.rows(); ++row) {
      for (std::size_t k = 0; k < places_.size(); ++k)
        x[places_[k]] = search_.rigs().coordinate_of_value(
            places_[k], value_of_number(between_[k], numbers(row, static_cast<Eigen::Index>(k))));
      if (!search_.predict(x, values)) continue;
      const std::uint64_t key = random_key(kNoiseKey, static_cast<std::uint64_t>(row));
      for (std::size_t i = 0; i < values.size(); ++i)
        predicted[i].push_back(values[i] + observations_.data()[i].std * random_normal(key, i));
    }
    std::size_t held = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (predicted[i].empty()) continue;
      const double measured = observations_.data()[i].measured;
      held += measured >= quantile(predicted[i], 0.05) && measured <= quantile(predicted[i], 0.95) ? 1 : 0;
    }
    return held;
  }

  // The same of the file's own numbers.
  std::size_t held_by_file() const {
    std::vector<double> values(readings());
    if (!search_.predict(start(), values)) return 0;
    std::size_t held = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const SoilDatum& datum = observations_.data()[i];
      held += std::abs(values[i] - datum.measured) <= kReach90 * datum.std ? 1 : 0;
    }
    return held;
  }

 private:
  static constexpr std::uint64_t kNoiseKey = 2010;

  static std::vector<double> deviations_of(const TestedSoilData& soil,
                                           const std::vector<FreeParameter>& between) {
    std::vector<double> deviations;
    for (const FreeParameter& axis : soil.options.free)
      deviations.push_back(holds(between, axis) && soil.options.priors != SoilPriors::kNone ? kFlat : 0.0);
    return deviations;
  }

  const std::vector<FreeParameter>& between_;
  mutable SoilObservations observations_;  // keeps where wheels stood
  SoilSearch search_;
  std::vector<std::size_t> places_;
  std::vector<double> left_;
};

std::vector<Fault> faults_of(std::span<const TestedSoilData> soils, const SoilBeliefOptions& options) {
  std::vector<Fault> faults;
  if (options.between.empty()) faults.push_back({"/between", "names no number that soils differ in"});
  if (soils.size() < 2) faults.push_back({"/soils", "a belief about soils takes the tests of two at least"});
  for (std::size_t s = 0; s < soils.size(); ++s) {
    const std::string place = fmt::format("/soils/{}", s);
    for (const FreeParameter& number : options.between) {
      if (!number.of.empty() || number.soil == SoilParameter::kKc || number.soil == SoilParameter::kKphi)
        faults.push_back({"/between", fmt::format("{} is no number of a whole soil", number.shown())});
      else if (!holds(soils[s].options.free, number))
        faults.push_back({place + "/free", fmt::format("{} is not free on soil {}, but in `between`",
                                                       number.name, soils[s].name)});
    }
    for (Fault& fault : gap::faults_of(soils[s].options.free, soils[s].data, soils[s].options))
      faults.push_back({place + fault.pointer, std::move(fault.message)});
  }
  return faults;
}

struct Sampled {
  std::vector<SoilSamples> soils;
  std::vector<TestedSoilBelief> beliefs;
  std::vector<BetweenNumber> numbers;
};

Result<SoilSamples> sample(SoilTests& tests, const std::string& name, const EnsembleOptions& options,
                           std::size_t numbers, TestedSoilBelief& belief, Progress& progress) {
  const auto fit = tests.fit(options.seed, progress);
  if (!fit) return fail(fit.error());
  belief.name = name;
  belief.readings = tests.readings();
  belief.residual_variance = fit->residual_variance;
  const LogDensity density = tests.density(std::max(1.0, fit->residual_variance));
  const auto ensemble = sample_ensemble(tests.starts(*fit, options), density, options, progress);
  if (!ensemble) return fail(ensemble.error());
  belief.effective_samples = ensemble->effective_samples;
  SoilSamples out{name, Eigen::MatrixXd(ensemble->samples.rows(), static_cast<Eigen::Index>(numbers))};
  std::vector<double> x(static_cast<std::size_t>(ensemble->samples.cols()));
  for (Eigen::Index row = 0; row < ensemble->samples.rows(); ++row) {
    Eigen::Map<Eigen::RowVectorXd>(x.data(), ensemble->samples.cols()) = ensemble->samples.row(row);
    for (std::size_t k = 0; k < numbers; ++k)
      out.values(row, static_cast<Eigen::Index>(k)) = tests.number(k, x);
  }
  belief.alone = numbers_of(out.values);
  return out;
}

// The soil as the others predict it.
Result<SoilLeftOut> left_out(const std::vector<SoilSamples>& soils, std::size_t without,
                             const SoilTests& tests, std::span<const BetweenNumber> numbers,
                             const EnsembleOptions& options, Progress& progress) {
  std::vector<SoilSamples> others = soils;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(without));
  const auto belief = between_soils(others, numbers, options, progress);
  if (!belief) return fail(belief.error());
  SoilLeftOut out;
  out.predicted = belief->next;
  const Eigen::MatrixXd &next = belief->next_samples, &own = soils[without].values;
  for (Eigen::Index k = 0; k < own.cols(); ++k) {
    const std::vector<double> values(own.col(k).begin(), own.col(k).end());
    out.rank.push_back((next.col(k).array() < median(values)).cast<double>().mean());
  }
  const Eigen::Index step = std::max<Eigen::Index>(1, next.rows() / kPredicted);
  Eigen::MatrixXd few(next.rows() / step, next.cols());
  for (Eigen::Index k = 0; k < few.rows(); ++k) few.row(k) = next.row(k * step);
  out.readings = {tests.readings(), tests.held(few), tests.held_by_file()};
  return out;
}

}  // namespace

Result<SoilBelief> believe_soils(std::span<const TestedSoilData> soils, const SoilBeliefOptions& options,
                                 Progress& progress) {
  if (auto faults = faults_of(soils, options); !faults.empty())
    return fail(ErrorCode::kInvalidRequest, "a belief can't be made of these soils so", std::move(faults));
  SoilBelief out;
  out.between = options.between;
  for (const FreeParameter& number : options.between) out.logarithm.push_back(by_logarithm(number));
  std::vector<std::unique_ptr<SoilTests>> tests;
  std::vector<SoilSamples> samples;
  std::vector<BetweenNumber> numbers;
  Within within(progress);
  const auto steps = static_cast<double>(2 * soils.size() + 1);
  for (const TestedSoilData& soil : soils) {
    progress.report("sampling " + soil.name, static_cast<double>(samples.size()) / steps);
    tests.push_back(std::make_unique<SoilTests>(soil, options));
    auto sampled = sample(*tests.back(), soil.name, options.of_soil, options.between.size(),
                          out.soils.emplace_back(), within);
    if (!sampled) return fail(sampled.error());
    samples.push_back(std::move(*sampled));
    for (std::size_t k = 0; k < options.between.size(); ++k) {
      const BetweenNumber bounds = tests.back()->bounds(
          k, k < options.usual_spread.size() ? std::optional(options.usual_spread[k]) : std::nullopt);
      if (k >= numbers.size()) numbers.push_back(bounds);
      numbers[k].lowest = std::min(numbers[k].lowest, bounds.lowest);
      numbers[k].highest = std::max(numbers[k].highest, bounds.highest);
    }
  }
  auto all = between_soils(samples, numbers, options.of_hierarchy, within);
  if (!all) return fail(all.error());
  out.all = std::move(*all);
  for (std::size_t s = 0; s < soils.size(); ++s) {
    progress.report("leaving out " + soils[s].name, static_cast<double>(soils.size() + 1 + s) / steps);
    out.soils[s].among = out.all.of_tested[s];
    auto left = left_out(samples, s, *tests[s], numbers, options.of_hierarchy, within);
    if (!left) return fail(left.error());
    out.soils[s].left_out = std::move(*left);
  }
  return out;
}

}  // namespace slipway::gap
