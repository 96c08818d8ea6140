#include "research/benchmark/baselines.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/parallel_for.h"
#include "gap/diagnosis/held_out/gap_closure.h"
#include "gap/diagnosis/search/prepared_campaign.h"

namespace slipway::gap {
namespace {

constexpr std::size_t kMaxTerms = 3;

// The chi^2 that a regression on columns with prior standard deviation 1 leaves, including the coefficients'
// prior.
double left_over(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd hessian = columns.transpose() * columns;
  hessian.diagonal().array() += 1.0;
  const Eigen::VectorXd gradient = columns.transpose() * residuals;
  return residuals.squaredNorm() - gradient.dot(hessian.llt().solve(gradient));
}

Eigen::MatrixXd beside(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd both(a.rows(), a.cols() + b.cols());
  both << a, b;
  return both;
}

// A Gaussian process with a squared-exponential kernel around 0 and known noise.
struct Kernel {
  double size = 0.0, length = 1.0;
  double operator()(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    return size * size * std::exp(-0.5 * (a - b).squaredNorm() / (length * length));
  }
};

struct Sample {
  Eigen::Index row = 0;
  Eigen::VectorXd at;
  double value = 0.0, noise = 0.0;
};

Eigen::MatrixXd covariance(std::span<const Sample> samples, const Kernel& kernel) {
  const auto n = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixXd k(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      k(i, j) = k(j, i) =
          kernel(samples[static_cast<std::size_t>(i)].at, samples[static_cast<std::size_t>(j)].at) +
          (i == j ? std::pow(samples[static_cast<std::size_t>(i)].noise, 2) : 0.0);
  return k;
}

// The means at `asked` by the kernel, of a small grid, under which the samples are most likely.
std::vector<double> means(std::span<const Sample> samples, std::span<const Sample> asked) {
  Eigen::VectorXd y(static_cast<Eigen::Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i) y[static_cast<Eigen::Index>(i)] = samples[i].value;
  const double rms = std::sqrt(y.squaredNorm() / static_cast<double>(y.size()));
  double best = -std::numeric_limits<double>::infinity();
  Kernel chosen;
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(y.size());
  for (const double size : {0.0, 0.3, 1.0, 3.0})
    for (const double length : {0.5, 1.0, 2.0, 4.0}) {
      const Kernel kernel{size * rms, length};
      const Eigen::LLT<Eigen::MatrixXd> factor(covariance(samples, kernel));
      const Eigen::VectorXd solved = factor.solve(y);
      const double likelihood = -0.5 * y.dot(solved) - factor.matrixLLT().diagonal().array().log().sum();
      if (!(likelihood > best)) continue;
      best = likelihood;
      chosen = kernel;
      weights = solved;
    }
  std::vector<double> out;
  for (const Sample& s : asked) {
    double mean = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i)
      mean += chosen(s.at, samples[i].at) * weights[static_cast<Eigen::Index>(i)];
    out.push_back(mean);
  }
  return out;
}

// The residuals less the predictions of Gaussian processes over the conditions, one for each channel and
// wheel.
Correction gaussian_process(const PreparedCampaign& prepared, const DiscrepancyOptions& options,
                            std::size_t threads) {
  return [&prepared, &options, threads](const FittedExplanation& retuned, const std::vector<bool>& seen) {
    const WindowModel& model = *prepared.model;
    const std::vector<double> predicted = retuned.hypothesis.predict(model, retuned.x, threads);
    const auto circumstance = circumstances(model, predicted, options);
    using Series = std::pair<std::vector<Sample>, std::vector<Sample>>;  // seen, asked
    std::map<std::pair<Channel, int>, Series> series;
    for (std::size_t w = 0; w < prepared.windows.size(); ++w) {
      if (!model.used(w)) continue;
      Eigen::VectorXd at(static_cast<Eigen::Index>(circumstance[w].size()));
      for (std::size_t v = 0; v < circumstance[w].size(); ++v)
        at[static_cast<Eigen::Index>(v)] = circumstance[w][v];
      for (std::size_t i = 0; i < prepared.windows[w].observations.size(); ++i) {
        const Observation& o = prepared.windows[w].observations[i];
        const std::size_t row = model.offset(w) + i;
        const auto r = static_cast<Eigen::Index>(row);
        const double noise = prepared.noise->deviation()[r];
        if (noise <= 0.0 || !std::isfinite(predicted[row])) continue;
        Series& own = series[{o.channel, o.wheel}];
        (seen[row] ? own.first : own.second).push_back({r, at, retuned.residuals[r], noise});
      }
    }
    std::vector<Series*> all;
    all.reserve(series.size());
    for (auto& [key, own] : series) all.push_back(&own);
    Eigen::VectorXd residuals = retuned.residuals;
    parallel_for(all.size(), threads, [&](std::size_t s) {
      const auto& [learnt, asked] = *all[s];
      if (learnt.empty()) return;
      const std::vector<double> corrections = means(learnt, asked);
      for (std::size_t i = 0; i < asked.size(); ++i) residuals[asked[i].row] -= corrections[i];
    });
    return residuals;
  };
}

Result<PreparedCampaign> prepared_for(const DriveCampaign& campaign, const DiagnosisOptions& options,
                                      Diagnosis& d, Progress& progress) {
  d.campaign = campaign.name;
  d.seed = options.seed;
  d.drives = campaign.drives.size();
  return prepare(campaign, options, progress);
}

}  // namespace

Result<Diagnosis> diagnose_by_sparse_regression(const DriveCampaign& campaign,
                                                const DiagnosisOptions& options, Progress& progress) {
  Diagnosis d;
  auto prepared = prepared_for(campaign, options, d, progress);
  if (!prepared) return fail(prepared.error());
  const FittedExplanation& null = *prepared->null;
  const std::vector<EffectVariant> variants = effect_variants(*campaign.rover, options.search.withheld);
  std::vector<Eigen::MatrixXd> columns(variants.size());
  parallel_for(variants.size(), options.search.threads, [&](std::size_t v) {
    std::vector<double> start;
    columns[v] =
        added_columns(Hypothesis(campaign, {variants[v]}), *prepared->model, *prepared->noise, null, start);
  });
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
  const double price = std::log(static_cast<double>(prepared->noise->used_count()));
  std::vector<std::string> found;
  Eigen::MatrixXd known = null.white_jacobian;
  double least = left_over(null.white_linear, known);
  while (found.size() < kMaxTerms) {
    double best = 0.0;  // fall of the criterion
    std::size_t chosen = 0;
    for (std::size_t v = 0; v < variants.size(); ++v) {
      if (std::find(found.begin(), found.end(), variants[v].effect) != found.end()) continue;
      const double fall = least - left_over(null.white_linear, beside(known, columns[v])) -
                          price * static_cast<double>(columns[v].cols());
      if (fall > best) {
        best = fall;
        chosen = v;
      }
    }
    if (best <= 0.0) break;
    known = beside(known, columns[chosen]);
    least = left_over(null.white_linear, known);
    found.push_back(variants[chosen].effect);
    d.effects.push_back({variants[chosen].effect, variants[chosen].label, 1.0, {}});
  }
  d.verdict = found.empty() ? Verdict::kNoGap : Verdict::kEffects;
  d.candidates.push_back({found, 1.0, std::nullopt, static_cast<int>(found.size())});
  return d;
}

Result<Diagnosis> diagnose_by_gaussian_process(const DriveCampaign& campaign, const DiagnosisOptions& options,
                                               Progress& progress) {
  Diagnosis d;
  const auto prepared = prepared_for(campaign, options, d, progress);
  if (!prepared) return fail(prepared.error());
  auto closure = close_gap_on_held_out(
      *prepared, campaign, gaussian_process(*prepared, options.discrepancy, options.search.threads),
      resample_drives(campaign, options.resamples, options.seed), options, progress);
  if (!closure) return fail(closure.error());
  d.verdict = Verdict::kUnknown;
  d.candidates.push_back({{}, 1.0, std::nullopt, 0, 0.0, true});
  d.gap = std::move(closure->channels);
  d.closed_fraction = closure->closed_fraction;
  return d;
}

DriveCampaign each_window_a_drive(const DriveCampaign& campaign, const WindowOptions& options) {
  DriveCampaign cut = campaign;
  cut.drives.clear();
  for (const DriveWindow& window : cut_windows(campaign, options)) {
    const MeasuredDriveSeries& whole = campaign.drives[window.drive];
    MeasuredDriveSeries piece = whole;
    piece.id = fmt::format("{} from {:g} s", whole.id, window.start_s);
    piece.repeat_of.reset();
    piece.duration_s = window.end_s - window.start_s;
    std::erase_if(piece.samples, [&](const DriveSample& sample) {
      return sample.time_s < window.start_s || sample.time_s > window.end_s;
    });
    if (piece.samples.size() >= 2) cut.drives.push_back(std::move(piece));
  }
  return cut;
}

Result<Diagnosis> diagnose_sample_by_sample(const DriveCampaign& campaign, const DiagnosisOptions& options,
                                            Progress& progress) {
  return diagnose(each_window_a_drive(campaign, options.windows), options, progress);
}

}  // namespace slipway::gap
