#include "gap/estimate/drive_tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "core/parallel_for.h"
#include "core/part_of_progress.h"

namespace slipway::gap {
namespace {

constexpr double kSweepShare = 0.7;  // of the progress

std::vector<Fault> faults_of(std::span<const MeasuredDrive> drives, const TuningOptions& options) {
  std::vector<Fault> faults;
  const auto positive = [&](const char* name, double value) {
    if (!(value > 0.0 && std::isfinite(value)))
      faults.push_back(
          {fmt::format("/options/{}", name), fmt::format("{} = {}, must be positive", name, value)});
  };
  if (drives.empty()) faults.push_back({"/drives", "there is no drive to tune to"});
  for (std::size_t i = 0; i < drives.size(); ++i)
    if (drives[i].finals.empty())
      faults.push_back({fmt::format("/drives/{}", i), drives[i].name + " has no measured end"});
  positive("position_m", options.scales.position_m);
  positive("heading_rad", options.scales.heading_rad);
  if (!(options.within >= 1.0))
    faults.push_back({"/options/within", fmt::format("within = {}, must be at least 1", options.within)});
  if (!(options.good_enough >= 0.0))
    faults.push_back(
        {"/options/good_enough", fmt::format("good_enough = {}, must be at least 0", options.good_enough)});
  if (options.loss_scale) positive("loss_scale", *options.loss_scale);
  return faults;
}

// Differences of an end, in units of the scales: along x, along y, of the heading.
std::array<double, 3> differences(const Pose2& simulated, const Pose2& measured, const ScoreScales& scales) {
  return {(simulated.x_m - measured.x_m) / scales.position_m,
          (simulated.y_m - measured.y_m) / scales.position_m,
          wrapped_rad(simulated.yaw_rad - measured.yaw_rad) / scales.heading_rad};
}

double squares(std::span<const double> values) {
  return std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
}

std::vector<TiltGroup> tilt_groups(std::span<const MeasuredDrive> drives, double same_tilt_rad) {
  std::vector<std::size_t> order(drives.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return drives[a].tilt_rad < drives[b].tilt_rad; });
  std::vector<TiltGroup> groups;
  for (const std::size_t i : order) {
    if (groups.empty() || drives[i].tilt_rad > drives[groups.back().drives.front()].tilt_rad + same_tilt_rad)
      groups.emplace_back();
    groups.back().drives.push_back(i);
  }
  for (TiltGroup& group : groups) {
    for (const std::size_t i : group.drives)
      group.tilt_rad += drives[i].tilt_rad / static_cast<double>(group.drives.size());
    std::sort(group.drives.begin(), group.drives.end());
  }
  return groups;
}

void find_best(const ParameterSweep& sweep, TiltGroup& group) {
  std::optional<double> best;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const std::optional<double> score = score_over(sweep.points[i], group.drives, sweep.weights);
    if (!score || (best && *score >= *best)) continue;
    best = score;
    group.best = i;
  }
  group.best_score = best.value_or(0.0);  // the best of all drives has a score on every tilt
}

SlopeService service_of(const SweepPoint& point, std::span<const double> weights,
                        std::span<const TiltGroup> tilts, const TuningOptions& options) {
  SlopeService service;
  int run = 0, longest = 0;
  for (std::size_t k = 0; k < tilts.size(); ++k) {
    const std::optional<double> score = score_over(point, tilts[k].drives, weights);
    const bool served =
        score && *score <= std::max(options.within * tilts[k].best_score, options.good_enough);
    service.scores.push_back(score);
    service.served.push_back(served);
    service.count += served ? 1 : 0;
    run = served ? run + 1 : 0;
    if (run <= longest) continue;
    longest = run;
    service.range = {tilts[k + 1 - static_cast<std::size_t>(run)].tilt_rad, tilts[k].tilt_rad};
  }
  return service;
}

std::size_t widest_of(const DriveTuning& tuning) {
  std::size_t widest = tuning.sweep.best;
  for (std::size_t i = 0; i < tuning.services.size(); ++i) {
    const auto& score = tuning.sweep.points[i].score;
    if (!score) continue;
    const int more = tuning.services[i].count - tuning.services[widest].count;
    if (more > 0 || (more == 0 && *score < *tuning.sweep.points[widest].score)) widest = i;
  }
  return widest;
}

class Fitter {
 public:
  Fitter(std::span<const TunedParameter> parameters, std::span<const MeasuredDrive> drives,
         const FinalPose& model, const TuningOptions& options)
      : parameters_(parameters), drives_(drives), model_(model), options_(options) {}

  // Over these drives, from a start.
  Result<TuningFit> fit(std::span<const std::size_t> chosen, std::span<const double> start,
                        Progress& progress) const {
    Known known;
    double noise = 1.0;
    auto found = options_.loss == RobustLoss::kNone ? fit_squares(chosen, start, known, noise, progress)
                                                    : fit_robustly(chosen, start, known, noise, progress);
    if (!found) return fail(found.error());
    for (double& r : found->residuals) r *= noise;
    TuningFit result{.fit = std::move(*found), .score = 0.0, .noise = noise, .beyond = {}};
    result.score =
        std::sqrt(3.0 * squares(result.fit.residuals) / static_cast<double>(result.fit.residuals.size()));
    if (options_.loss != RobustLoss::kNone) result.beyond = beyond(chosen, result.fit.residuals, noise);
    return result;
  }

 private:
  // Ends of the chosen drives by the parameters: a search asks for the same ones again.
  using Ends = std::vector<std::optional<Pose2>>;
  using Known = std::map<std::vector<double>, Ends>;

  const Ends& ends_at(std::span<const double> x, std::span<const std::size_t> chosen, Known& known) const {
    const auto [entry, is_new] = known.try_emplace(std::vector(x.begin(), x.end()), chosen.size());
    Ends& ends = entry->second;
    if (is_new)
      parallel_for(chosen.size(), options_.threads, [&](std::size_t i) { ends[i] = model_(chosen[i], x); });
    return ends;
  }

  double loss_scale() const { return options_.loss_scale.value_or(usual_loss_scale(options_.loss)); }

  // `noise` becomes the unit of what is returned.
  Result<LeastSquaresFit> fit_squares(std::span<const std::size_t> chosen, std::span<const double> start,
                                      Known& known, double& noise, Progress& progress) const {
    const bool priors = std::any_of(parameters_.begin(), parameters_.end(),
                                    [](const TunedParameter& p) { return p.prior.has_value(); });
    auto found = fit_in_units_of(1.0, chosen, start, options_.scales_are_errors, known, progress);
    if (!found || options_.scales_are_errors) return found;
    const auto freedom = static_cast<double>(found->residuals.size()) - static_cast<double>(start.size());
    const double left = squares(found->residuals);
    if (!(freedom > 0.0 && left > 0.0)) return found;
    // A prior weighs against residuals in units of their standard deviations: where those are not known, they
    // are estimated from what a first fit leaves over.
    noise = std::sqrt(left / freedom);
    if (priors) return fit_in_units_of(noise, chosen, std::vector(found->estimate), true, known, progress);
    found->residual_variance /= noise * noise;
    for (double& r : found->residuals) r /= noise;
    return found;
  }

  // The scale of the loss is in multiples of the noise. Where that is not known, fits with the noise that the
  // last one left over go on until it stays what it was.
  Result<LeastSquaresFit> fit_robustly(std::span<const std::size_t> chosen, std::span<const double> start,
                                       Known& known, double& noise, Progress& progress) const {
    constexpr int kMaxRounds = 8;
    constexpr double kSame = 0.05;
    if (options_.scales_are_errors) return fit_in_units_of(1.0, chosen, start, true, known, progress);
    std::vector<double> at(start.begin(), start.end());
    if (const auto first = residuals_at(at, chosen, known); !first.empty())
      noise = noise_of(first, start.size()).value_or(1.0);
    for (int round = 1;; ++round) {
      auto found = fit_in_units_of(noise, chosen, at, true, known, progress);
      if (!found) return found;
      const double next = noise * noise_of(found->residuals, start.size()).value_or(1.0);
      if (round == kMaxRounds || std::abs(next - noise) <= kSame * noise) return found;
      noise = next;
      at = found->estimate;
    }
  }

  // By the median of their sizes, as of normal residuals; nothing where that is 0.
  static std::optional<double> noise_of(std::span<const double> residuals, std::size_t unknowns) {
    constexpr double kMedianSize = 0.6744897501960817;  // of a standard normal number
    std::vector<double> sizes;
    for (const double r : residuals) sizes.push_back(std::abs(r));
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    if (!(*middle > 0.0) || sizes.size() <= unknowns) return std::nullopt;
    const auto count = static_cast<double>(sizes.size());
    return *middle / kMedianSize * std::sqrt(count / (count - static_cast<double>(unknowns)));
  }

  std::vector<std::size_t> beyond(std::span<const std::size_t> chosen, std::span<const double> residuals,
                                  double noise) const {
    std::vector<std::size_t> drives;
    std::size_t row = 0;
    for (const std::size_t i : chosen) {
      const std::span<const double> of_drive = residuals.subspan(row, 3 * drives_[i].finals.size());
      row += of_drive.size();
      if (std::any_of(of_drive.begin(), of_drive.end(),
                      [&](double r) { return std::abs(r) > loss_scale() * noise; }))
        drives.push_back(i);
    }
    return drives;
  }

  std::size_t rows_of(std::span<const std::size_t> chosen) const {
    std::size_t rows = 0;
    for (const std::size_t i : chosen) rows += 3 * drives_[i].finals.size();
    return rows;
  }

  // Differences in units of the scales; false where a drive has no end at x.
  bool fill(std::span<const double> x, std::span<const std::size_t> chosen, Known& known,
            std::span<double> r) const {
    const Ends& ends = ends_at(x, chosen, known);
    std::size_t row = 0;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (!ends[i]) return false;
      for (const Pose2& measured : drives_[chosen[i]].finals)
        for (const double off : differences(*ends[i], measured, options_.scales)) r[row++] = off;
    }
    return true;
  }

  std::vector<double> residuals_at(std::span<const double> x, std::span<const std::size_t> chosen,
                                   Known& known) const {
    std::vector<double> r(rows_of(chosen));
    if (!fill(x, chosen, known, r)) r.clear();
    return r;
  }

  // Residuals divided by `unit`.
  Result<LeastSquaresFit> fit_in_units_of(double unit, std::span<const std::size_t> chosen,
                                          std::span<const double> start, bool std_known, Known& known,
                                          Progress& progress) const {
    const std::size_t rows = rows_of(chosen);
    std::vector<Unknown> unknowns;
    for (std::size_t k = 0; k < parameters_.size(); ++k) {
      const SweptParameter& p = parameters_[k].sweep;
      unknowns.push_back({.name = p.name,
                          .start = start[k],
                          .lowest = p.lowest,
                          .highest = p.highest,
                          .step_scale = p.logarithmic ? start[k] : p.highest - p.lowest,
                          .prior = parameters_[k].prior});
    }
    const ResidualFunction residuals = [&](std::span<const double> x, std::span<double> r) {
      if (!fill(x, chosen, known, r)) return false;
      for (double& off : r) off /= unit;
      return true;
    };
    // A simulated drive's end is known to a few parts in ten thousand: steps stay well above that. The search
    // ends where a step changes the sum of squares by a hundredth of one residual's variance: a tenth of a
    // standard deviation.
    return fit_least_squares(unknowns, rows, residuals,
                             {.loss = options_.loss,
                              .loss_scale = loss_scale(),
                              .max_iterations = 40,
                              .tolerance = 0.01 / static_cast<double>(rows),
                              .relative_step = 1e-2,
                              .rank_tolerance = 1e-4,
                              .residual_std_known = std_known,
                              .widen = options_.scales_are_errors || options_.loss != RobustLoss::kNone},
                             progress);
  }

  std::span<const TunedParameter> parameters_;
  std::span<const MeasuredDrive> drives_;
  const FinalPose& model_;
  const TuningOptions& options_;
};

Result<void> fit_all(const Fitter& fitter, const TuningOptions& options, std::size_t drive_count,
                     DriveTuning& tuning, Progress& progress) {
  std::vector<std::size_t> all(drive_count);
  std::iota(all.begin(), all.end(), 0);
  const double fits = options.fit_each_tilt ? 1.0 + static_cast<double>(tuning.tilts.size()) : 1.0;
  const double each = (1.0 - kSweepShare) / fits;
  PartOfProgress first(progress, kSweepShare, kSweepShare + each);
  auto fit = fitter.fit(all, tuning.sweep.points[tuning.sweep.best].x, first);
  if (!fit) return fail(fit.error());
  tuning.fit = std::move(*fit);
  for (std::size_t k = 0; options.fit_each_tilt && k < tuning.tilts.size(); ++k) {
    TiltGroup& group = tuning.tilts[k];
    const double begin = kSweepShare + each * static_cast<double>(k + 1);
    PartOfProgress part(progress, begin, begin + each);
    auto of_tilt = fitter.fit(group.drives, tuning.sweep.points[group.best].x, part);
    if (!of_tilt) return fail(of_tilt.error());
    group.fit = std::move(*of_tilt);
  }
  return {};
}

}  // namespace

double final_score(const Pose2& simulated, const Pose2& measured, const ScoreScales& scales) {
  return std::sqrt(squares(differences(simulated, measured, scales)));
}

Result<DriveTuning> tune_drives(std::span<const TunedParameter> parameters,
                                std::span<const MeasuredDrive> drives, const FinalPose& model,
                                const TuningOptions& options, Progress& progress) {
  if (auto faults = faults_of(drives, options); !faults.empty())
    return fail(ErrorCode::kInvalidRequest, "the drives can't be tuned to", std::move(faults));
  std::vector<SweptParameter> swept;
  for (const TunedParameter& p : parameters) swept.push_back(p.sweep);
  const ScoreOfCase score = [&](std::size_t drive, std::span<const double> x) -> std::optional<double> {
    const std::optional<Pose2> end = model(drive, x);
    if (!end) return std::nullopt;
    double sum = 0.0;
    for (const Pose2& measured : drives[drive].finals)
      sum += std::pow(final_score(*end, measured, options.scales), 2);
    return std::sqrt(sum / static_cast<double>(drives[drive].finals.size()));
  };
  std::vector<double> repeats;
  for (const MeasuredDrive& drive : drives) repeats.push_back(static_cast<double>(drive.finals.size()));
  PartOfProgress sweeping(progress, 0.0, options.least_squares ? kSweepShare : 1.0);
  auto sweep = sweep_coarse_then_fine(swept, repeats, score, options.threads, sweeping);
  if (!sweep) return fail(sweep.error());
  DriveTuning tuning{.sweep = std::move(*sweep),
                     .tilts = tilt_groups(drives, options.same_tilt_rad),
                     .services = {},
                     .widest = 0,
                     .fit = {}};
  for (TiltGroup& group : tuning.tilts) find_best(tuning.sweep, group);
  for (const SweepPoint& point : tuning.sweep.points)
    tuning.services.push_back(service_of(point, tuning.sweep.weights, tuning.tilts, options));
  tuning.widest = widest_of(tuning);
  if (options.least_squares) {
    const Fitter fitter(parameters, drives, model, options);
    if (auto fitted = fit_all(fitter, options, drives.size(), tuning, progress); !fitted)
      return fail(fitted.error());
  }
  return tuning;
}

}  // namespace slipway::gap
