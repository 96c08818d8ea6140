#include "gap/diagnosis/held_out/extrapolation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.h"
#include "core/quantile.h"

namespace slipway::gap {
namespace {

// How harsh a window is: the more, the larger `sense` times the number is. What differs by less than
// `min_range` over a campaign is not extrapolated.
struct Harshness {
  std::string_view variable;
  double sense;
  double ExtrapolationOptions::*min_range;
  double (*of)(const WindowModel& model, std::size_t window);
};

constexpr std::array kHarshness{
    Harshness{"slope_deg", 1.0, &ExtrapolationOptions::min_slope_range_deg,
              [](const WindowModel& model, std::size_t w) {
                const WindowModel::Conditions& at = model.conditions(w);
                return deg_from_rad(std::hypot(at.pitch_rad, at.roll_rad));
              }},
    Harshness{"motor_temp_c", -1.0, &ExtrapolationOptions::min_temperature_range_c,
              [](const WindowModel& model, std::size_t w) {
                const sim::DriveCommand& command = model.windows()[w].command;
                return command.motor_temp_c.value_or(model.campaign().rover->drive.reference_temp_c);
              }},
    Harshness{"speed_m_s", 1.0, &ExtrapolationOptions::min_speed_range_m_s,
              [](const WindowModel& model, std::size_t w) {
                return std::abs(model.windows()[w].command.speed_m_s);
              }}};

// The mean harshness of each group's windows; NaN where none is used.
std::vector<double> mean_by_group(const Harshness& harshness, const WindowModel& model,
                                  const DriveResampling& drives) {
  std::vector<double> sum(drives.group_count, 0.0), count(drives.group_count, 0.0);
  for (std::size_t w = 0; w < model.windows().size(); ++w) {
    if (!model.used(w)) continue;
    const std::size_t group = drives.groups[model.windows()[w].drive];
    sum[group] += harshness.of(model, w);
    count[group] += 1.0;
  }
  for (std::size_t g = 0; g < sum.size(); ++g) sum[g] *= harshness.sense / count[g];
  return sum;
}

// The gain of each group of drives that was not learnt from and has something to compare.
std::vector<double> gains_of(const PreparedCampaign& prepared, const HeldOutComparison& comparison,
                             const DriveResampling& drives, const std::vector<bool>& learnt_from) {
  const WindowModel& model = *prepared.model;
  std::vector<HeldOutErrors> errors(drives.group_count);
  for (std::size_t w = 0; w < model.windows().size(); ++w)
    if (!learnt_from[model.windows()[w].drive] && model.used(w))
      errors[drives.groups[model.windows()[w].drive]].add(comparison.errors(w));
  std::vector<double> gains;
  for (const HeldOutErrors& e : errors)
    if (e.scaled_count > 0.0) gains.push_back(e.log_gain);
  return gains;
}

}  // namespace

std::optional<double> harsh_from(std::span<const double> harshness, double min_range,
                                 const ExtrapolationOptions& options) {
  std::vector<double> known;
  std::copy_if(harshness.begin(), harshness.end(), std::back_inserter(known),
               [](double h) { return std::isfinite(h); });
  // A third of them is predicted.
  if (known.size() < 3 * static_cast<std::size_t>(options.min_groups)) return std::nullopt;
  const auto [least, most] = std::minmax_element(known.begin(), known.end());
  if (*most - *least < min_range) return std::nullopt;
  return quantile(known, options.learnt_quantile);
}

MeanGain mean_gain(std::span<const double> gains) {
  const auto n = static_cast<double>(gains.size());
  double sum = 0.0, square = 0.0;
  for (const double g : gains) sum += g;
  for (const double g : gains) square += (g - sum / n) * (g - sum / n);
  return {sum / n, std::sqrt(square / (n - 1.0) / n)};
}

Result<std::vector<Extrapolation>> extrapolate(const PreparedCampaign& prepared,
                                               const DriveCampaign& campaign, const Correction& correction,
                                               const DriveResampling& drives, const DiagnosisOptions& options,
                                               Progress& progress) {
  const WindowModel& model = *prepared.model;
  std::vector<Extrapolation> all;
  for (const Harshness& harshness : kHarshness) {
    const std::vector<double> mean = mean_by_group(harshness, model, drives);
    const auto from = harsh_from(mean, options.extrapolation.*harshness.min_range, options.extrapolation);
    if (!from) continue;
    std::vector<bool> learnt_from;
    for (std::size_t d = 0; d < campaign.drives.size(); ++d)
      learnt_from.push_back(!(mean[drives.groups[d]] > *from));
    const std::vector<bool> seen = rows_of(model, learnt_from);
    progress.report("predicting harsh drives from gentle ones", 0.96);
    const FittedExplanation retuned = retuned_on(prepared, seen, options);
    const HeldOutComparison comparison(prepared, retuned.residuals, correction(retuned, seen), options.fit);
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
    const std::vector<double> gains = gains_of(prepared, comparison, drives, learnt_from);
    if (gains.size() < static_cast<std::size_t>(options.extrapolation.min_groups)) continue;
    const MeanGain gain = mean_gain(gains);
    all.push_back({std::string(harshness.variable), harshness.sense > 0.0, harshness.sense * *from,
                   gains.size(), gain.mean, gain.error});
  }
  return all;
}

}  // namespace slipway::gap
