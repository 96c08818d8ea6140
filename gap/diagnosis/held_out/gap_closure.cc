#include "gap/diagnosis/held_out/gap_closure.h"

#include <algorithm>
#include <cmath>

#include "core/quantile.h"
#include "gap/diagnosis/held_out/planners_view.h"

namespace slipway::gap {
namespace {

// In deviations of the noise, the floor being 1.
std::optional<double> closed(const HeldOutErrors& e) {
  return closed_share(e.scaled_retuned, e.scaled_with, e.scaled_count, e.scaled_count);
}

std::optional<double> closed(const HeldOutErrors& e, std::size_t c) {
  return closed_share(e.retuned[c], e.with[c], e.floor[c], e.count[c]);
}

// A window, for pictures and maps.
void keep(const PreparedCampaign& prepared, const DriveCampaign& campaign,
          const HeldOutComparison& comparison, const HeldOutErrors& errors, std::size_t w,
          GapClosure& closure) {
  const DriveWindow& window = prepared.windows[w];
  for (std::size_t i = 0; i < window.observations.size(); ++i) {
    if (!comparison.compares(w, i)) continue;
    const Observation& o = window.observations[i];
    const std::size_t row = prepared.model->offset(w) + i;
    closure.points.push_back({o.channel, o.wheel, window.drive, window.start_s, o.value,
                              o.value - prepared.nominal_residuals[static_cast<Eigen::Index>(row)],
                              o.value - comparison.retuned(row), o.value - comparison.corrected(row)});
  }
  if (errors.scaled_count == 0.0) return;
  closure.windows.push_back({campaign.drives[window.drive].terrain, window.drive, window.start_s,
                             window.stations, std::sqrt(errors.scaled_nominal / errors.scaled_count),
                             std::sqrt(errors.scaled_retuned / errors.scaled_count),
                             std::sqrt(errors.scaled_with / errors.scaled_count)});
}

// Root mean squares of each channel that has values, and what is closed of its gap.
std::vector<ChannelClosure> channels_of(const Bootstrapped& sums) {
  std::vector<ChannelClosure> channels;
  for (std::size_t c = 0; c < channel_count(); ++c) {
    if (sums.all.count[c] == 0.0) continue;
    const auto rms = [&](const auto& squares) {
      return sums.interval([c, squares](const HeldOutErrors& e) {
        return e.count[c] > 0.0 ? std::sqrt((e.*squares)[c] / e.count[c]) : 0.0;
      });
    };
    channels.push_back({static_cast<Channel>(c), rms(&HeldOutErrors::nominal), rms(&HeldOutErrors::retuned),
                        rms(&HeldOutErrors::with), rms(&HeldOutErrors::floor),
                        sums.closed_interval([c](const HeldOutErrors& e) { return closed(e, c); })});
  }
  return channels;
}

// The correction tried fold after fold.
class FoldedErrors {
 public:
  FoldedErrors(const PreparedCampaign& prepared, const DriveCampaign& campaign, const Correction& correction,
               const DriveResampling& drives, const DiagnosisOptions& options)
      : prepared_(prepared),
        campaign_(campaign),
        correction_(correction),
        drives_(drives),
        options_(options),
        tally_(prepared, campaign.drives.size(), options.held_out),
        errors_(drives.group_count) {}

  // False where it was cancelled.
  bool add_fold(int fold, const Progress& progress) {
    const std::vector<bool> learnt_from = learnt_from_in(drives_.groups, fold, options_.folds);
    if (std::find(learnt_from.begin(), learnt_from.end(), false) == learnt_from.end()) return true;
    const std::vector<bool> seen = rows_of(*prepared_.model, learnt_from);
    const FittedExplanation retuned = retuned_on(prepared_, seen, options_);
    if (progress.cancelled()) return false;
    const HeldOutComparison comparison(prepared_, retuned.residuals, correction_(retuned, seen),
                                       options_.fit);
    for (std::size_t w = 0; w < prepared_.windows.size(); ++w)
      if (!learnt_from[prepared_.windows[w].drive] && prepared_.model->used(w)) add_window(w, comparison);
    return true;
  }

  // The figures of all folds together.
  GapClosure closure() {
    closure_.planners_view = tally_.view();
    double groups = 0.0;
    for (const HeldOutErrors& e : errors_) groups += e.scaled_count > 0.0 ? 1.0 : 0.0;
    if (groups == 0.0) return std::move(closure_);
    const Bootstrapped sums = bootstrap_errors(errors_, drives_.resamples);
    closure_.channels = channels_of(sums);
    closure_.closed_fraction = sums.closed_interval([](const HeldOutErrors& e) { return closed(e); });
    closure_.log_density_gain = sums.all.log_gain / groups;
    return std::move(closure_);
  }

 private:
  void add_window(std::size_t w, const HeldOutComparison& comparison) {
    const HeldOutErrors of_window = comparison.errors(w);
    errors_[drives_.groups[prepared_.windows[w].drive]].add(of_window);
    tally_.add(w, comparison);
    keep(prepared_, campaign_, comparison, of_window, w, closure_);
  }

  const PreparedCampaign& prepared_;
  const DriveCampaign& campaign_;
  const Correction& correction_;
  const DriveResampling& drives_;
  const DiagnosisOptions& options_;
  PlannersTally tally_;
  std::vector<HeldOutErrors> errors_;  // by group of drives
  GapClosure closure_;
};

}  // namespace

std::vector<bool> learnt_from_in(std::span<const std::size_t> groups, int fold, int folds) {
  std::vector<bool> learnt_from;
  for (const std::size_t group : groups)
    learnt_from.push_back(static_cast<int>(group % static_cast<std::size_t>(folds)) != fold);
  return learnt_from;
}

std::optional<double> closed_share(double before, double after, double floor, double count) {
  if (!(count > 0.0) || !(before > floor)) return std::nullopt;
  const double gap = std::sqrt(before / count) - std::sqrt(floor / count);
  return std::clamp((std::sqrt(before / count) - std::sqrt(after / count)) / gap, 0.0, 1.0);
}

Interval Bootstrapped::interval(const std::function<double(const HeldOutErrors&)>& number) const {
  std::vector<double> values;
  for (const HeldOutErrors& e : resampled) values.push_back(number(e));
  return {number(all), quantile(values, 0.05), quantile(values, 0.95)};
}

std::optional<Interval> Bootstrapped::closed_interval(
    const std::function<std::optional<double>(const HeldOutErrors&)>& number) const {
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

Bootstrapped bootstrap_errors(std::span<const HeldOutErrors> errors,
                              std::span<const std::vector<std::size_t>> resamples) {
  Bootstrapped sums;
  for (const HeldOutErrors& e : errors) sums.all.add(e);
  for (const std::vector<std::size_t>& resample : resamples) {
    sums.resampled.emplace_back();
    for (const std::size_t group : resample) sums.resampled.back().add(errors[group]);
  }
  return sums;
}

Result<GapClosure> close_gap_on_held_out(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                                         const Correction& correction, const DriveResampling& drives,
                                         const DiagnosisOptions& options, Progress& progress) {
  FoldedErrors errors(prepared, campaign, correction, drives, options);
  for (int f = 0; f < options.folds; ++f) {
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
    progress.report("predicting held-out drives", 0.8 + 0.15 * f / options.folds);
    if (!errors.add_fold(f, progress)) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
  }
  return errors.closure();
}

}  // namespace slipway::gap
