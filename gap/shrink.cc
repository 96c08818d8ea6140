#include "gap/shrink.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "gap/drive_resampling.h"

namespace slipway::gap {
namespace {

// Sums of squares of one drive, by channel.
struct DriveErrors {
  std::array<double, kChannels> nominal{}, retuned{}, with{}, floor{};
  std::array<int, kChannels> count{};
  double scaled_retuned = 0.0, scaled_with = 0.0;  // in deviations
  int scaled_count = 0;
  double log_gain = 0.0;
};

// A fold for each drive; repeats share theirs. Folds alternate along the list, so that each has every kind.
std::vector<int> folds_of(const DriveCampaign& campaign, int folds) {
  std::vector<int> fold;
  for (const std::size_t group : repeat_groups(campaign))
    fold.push_back(static_cast<int>(group % static_cast<std::size_t>(folds)));
  return fold;
}

struct Totals {
  std::array<double, kChannels> nominal{}, retuned{}, with{}, floor{}, count{};
  double scaled_retuned = 0.0, scaled_with = 0.0, scaled_count = 0.0;

  void add(const DriveErrors& e) {
    for (int c = 0; c < kChannels; ++c) {
      nominal[c] += e.nominal[c];
      retuned[c] += e.retuned[c];
      with[c] += e.with[c];
      floor[c] += e.floor[c];
      count[c] += e.count[c];
    }
    scaled_retuned += e.scaled_retuned;
    scaled_with += e.scaled_with;
    scaled_count += e.scaled_count;
  }
  // Of root mean squares in deviations, the floor being 1.
  std::optional<double> closed() const {
    return closed_of(scaled_retuned, scaled_with, scaled_count, scaled_count);
  }
  std::optional<double> closed(int c) const { return closed_of(retuned[c], with[c], floor[c], count[c]); }

 private:
  // Of sums of squares. Nothing where no gap was left to close.
  static std::optional<double> closed_of(double before, double after, double least, double count) {
    if (!(count > 0.0) || !(before > least)) return std::nullopt;
    const double gap = std::sqrt(before / count) - std::sqrt(least / count);
    return std::clamp((std::sqrt(before / count) - std::sqrt(after / count)) / gap, 0.0, 1.0);
  }
};

ExplanationOptions fit_options_of(std::size_t threads) {
  ExplanationOptions options;
  options.threads = threads;
  options.iterations = 4;
  return options;
}

}  // namespace

Correction refitted(const PreparedCampaign& prepared, const FittedExplanation& explanation,
                    std::size_t threads) {
  return [&prepared, &explanation, threads](const FittedExplanation&, const std::vector<bool>& seen) {
    return fit_explanation(explanation.hypothesis, *prepared.model, *prepared.noise, explanation.x,
                           fit_options_of(threads), seen)
        .residuals;
  };
}

Result<Shrink> shrink_on_held_out(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                  const Correction& with, const DiagnosisOptions& options,
                                  Progress& progress) {
  const WindowModel& model = *prepared.model;
  const NoiseModel& noise = *prepared.noise;
  const std::vector<int> fold = folds_of(campaign, options.folds);
  std::vector<DriveErrors> errors(campaign.drives.size());
  std::vector<HeldOutPoint> points;
  std::vector<WindowGap> gaps;
  const ExplanationOptions fit_options = fit_options_of(options.search.threads);
  for (int f = 0; f < options.folds; ++f) {
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
    progress.report("predicting held-out drives", 0.8 + 0.15 * f / options.folds);
    std::vector<bool> seen(model.observation_count(), false);
    for (std::size_t w = 0; w < prepared.windows.size(); ++w)
      for (std::size_t i = 0; i < prepared.windows[w].observations.size(); ++i)
        seen[model.offset(w) + i] = fold[prepared.windows[w].drive] != f;
    if (std::find(seen.begin(), seen.end(), false) == seen.end()) continue;
    const FittedExplanation retuned =
        fit_explanation(prepared.null->hypothesis, model, noise, prepared.null->x, fit_options, seen);
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
    const Eigen::VectorXd found = with(retuned, seen);
    const Eigen::VectorXd white_retuned = noise.whiten(retuned.residuals), white_found = noise.whiten(found);
    for (std::size_t w = 0; w < prepared.windows.size(); ++w) {
      const DriveWindow& window = prepared.windows[w];
      if (fold[window.drive] != f || !model.used(w)) continue;
      DriveErrors& e = errors[window.drive];
      WindowGap gap{campaign.drives[window.drive].terrain, window.drive, window.start_s, window.stations};
      int counted = 0;
      for (std::size_t i = 0; i < window.observations.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(model.offset(w) + i);
        const double deviation = noise.deviation()[row];
        if (deviation <= 0.0 || !std::isfinite(prepared.nominal_residuals[row])) continue;
        if (window.censored && window.observations[i].channel == Channel::kSlip) continue;
        const double value = window.observations[i].value;
        points.push_back({window.observations[i].channel, window.observations[i].wheel, window.drive,
                          window.start_s, value, value - prepared.nominal_residuals[row],
                          value - retuned.residuals[row], value - found[row]});
        const auto c = static_cast<std::size_t>(window.observations[i].channel);
        e.nominal[c] += std::pow(prepared.nominal_residuals[row], 2);
        e.retuned[c] += std::pow(retuned.residuals[row], 2);
        e.with[c] += std::pow(found[row], 2);
        e.floor[c] += deviation * deviation;
        ++e.count[c];
        gap.nominal += std::pow(prepared.nominal_residuals[row] / deviation, 2);
        gap.retuned += std::pow(retuned.residuals[row] / deviation, 2);
        gap.with_effects += std::pow(found[row] / deviation, 2);
        ++counted;
        e.scaled_retuned += std::pow(retuned.residuals[row] / deviation, 2);
        e.scaled_with += std::pow(found[row] / deviation, 2);
        ++e.scaled_count;
        // As heavy-tailed as the fits' loss.
        const auto loss = [&](double r) {
          const double a = std::abs(r);
          return a <= fit_options.huber ? 0.5 * a * a : fit_options.huber * (a - 0.5 * fit_options.huber);
        };
        e.log_gain += loss(white_retuned[row]) - loss(white_found[row]);
      }
      if (counted == 0) continue;
      for (double* sum : {&gap.nominal, &gap.retuned, &gap.with_effects}) *sum = std::sqrt(*sum / counted);
      gaps.push_back(std::move(gap));
    }
  }
  Totals all;
  std::vector<std::size_t> with_data;
  for (std::size_t d = 0; d < errors.size(); ++d)
    if (errors[d].scaled_count > 0) {
      all.add(errors[d]);
      with_data.push_back(d);
    }
  Shrink shrink;
  shrink.points = std::move(points);
  shrink.windows = std::move(gaps);
  if (with_data.empty()) return shrink;
  std::vector<Totals> resampled;
  for (const auto& picks : resampled_indices(with_data.size(), options.resamples, options.seed)) {
    Totals t;
    for (const std::size_t pick : picks) t.add(errors[with_data[pick]]);
    resampled.push_back(t);
  }
  // A resample that leaves nothing to close says neither end: it counts for both.
  const auto closed_interval = [&](const auto& number) -> std::optional<Interval> {
    const std::optional<double> value = number(all);
    if (!value) return std::nullopt;
    std::vector<double> low, high;
    for (const Totals& t : resampled) {
      const std::optional<double> share = number(t);
      low.push_back(share.value_or(0.0));
      high.push_back(share.value_or(1.0));
    }
    return Interval{*value, quantile(std::move(low), 0.05), quantile(std::move(high), 0.95)};
  };
  const auto interval = [&](const auto& number) {
    std::vector<double> values;
    for (const Totals& t : resampled) values.push_back(number(t));
    return Interval{number(all), quantile(values, 0.05), quantile(values, 0.95)};
  };
  for (int c = 0; c < kChannels; ++c) {
    if (all.count[c] == 0.0) continue;
    const auto rms = [c](const auto& sums) {
      return [c, sums](const Totals& t) {
        return t.count[c] > 0.0 ? std::sqrt((t.*sums)[c] / t.count[c]) : 0.0;
      };
    };
    shrink.channels.push_back({static_cast<Channel>(c), interval(rms(&Totals::nominal)),
                               interval(rms(&Totals::retuned)), interval(rms(&Totals::with)),
                               interval(rms(&Totals::floor)),
                               closed_interval([c](const Totals& t) { return t.closed(c); })});
  }
  shrink.closed_fraction = interval([](const Totals& t) { return t.closed().value_or(0.0); });
  double mean = 0.0, square = 0.0;
  for (const std::size_t d : with_data) mean += errors[d].log_gain / static_cast<double>(with_data.size());
  for (const std::size_t d : with_data) square += std::pow(errors[d].log_gain - mean, 2);
  shrink.log_density_gain = mean;
  shrink.gain_error = std::sqrt(square) / static_cast<double>(with_data.size());
  return shrink;
}

}  // namespace slipway::gap
