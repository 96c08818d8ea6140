#include "gap/diagnosis/held_out/gap_closure.h"

#include <algorithm>
#include <cmath>

#include "core/quantile.h"
#include "gap/diagnosis/held_out/planners_view.h"

namespace slipway::gap {
namespace {

// Of root mean squares from sums of squares. Nothing where no gap was left to close.
std::optional<double> closed_of(double before, double after, double least, double count) {
  if (!(count > 0.0) || !(before > least)) return std::nullopt;
  const double gap = std::sqrt(before / count) - std::sqrt(least / count);
  return std::clamp((std::sqrt(before / count) - std::sqrt(after / count)) / gap, 0.0, 1.0);
}

// In deviations of the noise, the floor being 1.
std::optional<double> closed(const HeldOutErrors& e) {
  return closed_of(e.scaled_retuned, e.scaled_with, e.scaled_count, e.scaled_count);
}

std::optional<double> closed(const HeldOutErrors& e, std::size_t c) {
  return closed_of(e.retuned[c], e.with[c], e.floor[c], e.count[c]);
}

// All drives, and each resample of them.
struct Bootstrapped {
  HeldOutErrors all;
  std::vector<HeldOutErrors> resampled;

  template <class Number>
  Interval interval(const Number& number) const {
    std::vector<double> values;
    for (const HeldOutErrors& e : resampled) values.push_back(number(e));
    return {number(all), quantile(values, 0.05), quantile(values, 0.95)};
  }

  // A resample that leaves nothing to close says neither end: it counts for both.
  template <class Number>
  std::optional<Interval> closed_interval(const Number& number) const {
    const std::optional<double> value = number(all);
    if (!value) return std::nullopt;
    std::vector<double> low, high;
    for (const HeldOutErrors& e : resampled) {
      const std::optional<double> share = number(e);
      low.push_back(share.value_or(0.0));
      high.push_back(share.value_or(1.0));
    }
    return Interval{*value, quantile(std::move(low), 0.05), quantile(std::move(high), 0.95)};
  }
};

// A window of the told correction, for pictures and maps.
void keep(const PreparedCampaign& prepared, const DriveCampaign& campaign,
          const HeldOutComparison& comparison, const HeldOutErrors& errors, std::size_t w, Shrink& shrink) {
  const DriveWindow& window = prepared.windows[w];
  for (std::size_t i = 0; i < window.observations.size(); ++i) {
    if (!comparison.compares(w, i)) continue;
    const Observation& o = window.observations[i];
    const std::size_t row = prepared.model->offset(w) + i;
    shrink.points.push_back({o.channel, o.wheel, window.drive, window.start_s, o.value,
                             o.value - prepared.nominal_residuals[static_cast<Eigen::Index>(row)],
                             o.value - comparison.retuned(row), o.value - comparison.corrected(row)});
  }
  if (errors.scaled_count == 0.0) return;
  shrink.windows.push_back({campaign.drives[window.drive].terrain, window.drive, window.start_s,
                            window.stations, std::sqrt(errors.scaled_nominal / errors.scaled_count),
                            std::sqrt(errors.scaled_retuned / errors.scaled_count),
                            std::sqrt(errors.scaled_with / errors.scaled_count)});
}

}  // namespace

Result<Shrink> close_gap_on_held_out(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                     const CorrectionChoice& choice, const DriveResampling& drives,
                                     const DiagnosisOptions& options, Progress& progress) {
  const WindowModel& model = *prepared.model;
  Shrink shrink;
  PlannersTally tally(prepared, campaign.drives.size());
  // By correction and group of drives.
  std::vector<std::vector<HeldOutErrors>> errors(choice.corrections.size(),
                                                 std::vector<HeldOutErrors>(drives.group_count));
  for (int f = 0; f < options.folds; ++f) {
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
    progress.report("predicting held-out drives", 0.8 + 0.15 * f / options.folds);
    // Folds alternate along the list of drives, so that each has every kind; repeats share theirs.
    std::vector<bool> learnt_from;
    for (const std::size_t group : drives.groups)
      learnt_from.push_back(static_cast<int>(group % static_cast<std::size_t>(options.folds)) != f);
    if (std::find(learnt_from.begin(), learnt_from.end(), false) == learnt_from.end()) continue;
    const std::vector<bool> seen = rows_of(model, learnt_from);
    const FittedExplanation retuned = retuned_on(prepared, seen, options.search.threads);
    for (std::size_t k = 0; k < choice.corrections.size(); ++k) {
      if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
      const HeldOutComparison comparison(prepared, retuned.residuals, choice.corrections[k](retuned, seen));
      for (std::size_t w = 0; w < prepared.windows.size(); ++w) {
        const std::size_t drive = prepared.windows[w].drive;
        if (learnt_from[drive] || !model.used(w)) continue;
        const HeldOutErrors of_window = comparison.errors(w);
        errors[k][drives.groups[drive]].add(of_window);
        if (k == 0) tally.add(w, comparison);
        if (k == 0) keep(prepared, campaign, comparison, of_window, w, shrink);
      }
    }
  }
  shrink.planners_view = tally.view();
  Bootstrapped sums;
  double groups = 0.0;
  for (const HeldOutErrors& e : errors[0]) {
    sums.all.add(e);
    groups += e.scaled_count > 0.0 ? 1.0 : 0.0;
  }
  if (groups == 0.0) return shrink;
  for (std::size_t b = 0; b < drives.resamples.size(); ++b) {
    const std::size_t chosen = choice.of_resample.empty() ? 0 : choice.of_resample[b];
    sums.resampled.emplace_back();
    for (const std::size_t group : drives.resamples[b]) sums.resampled.back().add(errors[chosen][group]);
  }
  for (std::size_t c = 0; c < channel_count(); ++c) {
    if (sums.all.count[c] == 0.0) continue;
    const auto rms = [&](const auto& squares) {
      return sums.interval([c, squares](const HeldOutErrors& e) {
        return e.count[c] > 0.0 ? std::sqrt((e.*squares)[c] / e.count[c]) : 0.0;
      });
    };
    shrink.channels.push_back({static_cast<Channel>(c), rms(&HeldOutErrors::nominal),
                               rms(&HeldOutErrors::retuned), rms(&HeldOutErrors::with),
                               rms(&HeldOutErrors::floor),
                               sums.closed_interval([c](const HeldOutErrors& e) { return closed(e, c); })});
  }
  shrink.closed_fraction = sums.interval([](const HeldOutErrors& e) { return closed(e).value_or(0.0); });
  shrink.log_density_gain = sums.all.log_gain / groups;
  return shrink;
}

}  // namespace slipway::gap
