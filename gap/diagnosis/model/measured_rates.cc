#include "gap/diagnosis/model/measured_rates.h"

#include <algorithm>
#include <cmath>

#include "core/quantile.h"
#include "gap/diagnosis/model/window_readings.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::gap {
namespace {

constexpr double kTurning = 0.5;     // of the commanded rate, of all wheels together: they turn
constexpr double kMinRows = 10;      // fewer tell no median
constexpr double kRateError = 0.03;  // of a median, by starts, halts and curves

// The rates over the commanded ones in a row; nothing where one was not measured or commanded, or the wheels
// stand.
std::optional<std::vector<double>> shares_in(const DriveSample& sample,
                                             const sim::PerWheel<sim::WheelCommand>& commanded) {
  std::vector<double> shares;
  double sum = 0.0;
  for (std::size_t k = 0; k < commanded.size(); ++k) {
    if (commanded[k].rate_rad_s == 0.0) return std::nullopt;
    shares.push_back(sample.wheels[k].rate_rad_s / commanded[k].rate_rad_s);
    if (!std::isfinite(shares.back())) return std::nullopt;
    sum += shares.back();
  }
  if (sum < kTurning * static_cast<double>(shares.size())) return std::nullopt;
  return shares;
}

}  // namespace

std::optional<std::vector<double>> measured_rate_shares(const DriveCampaign& campaign) {
  std::vector<std::vector<double>> of_wheel(campaign.rover->wheels.size());
  for (const MeasuredDriveSeries& drive : campaign.drives) {
    const auto commanded = sim::wheel_commands(*campaign.rover, drive.command);
    for (const DriveSample& sample : drive.samples)
      if (const auto shares = shares_in(sample, commanded))
        for (std::size_t k = 0; k < shares->size(); ++k) of_wheel[k].push_back((*shares)[k]);
  }
  if (of_wheel.empty() || static_cast<double>(of_wheel.front().size()) < kMinRows) return std::nullopt;
  std::vector<double> medians;
  for (std::vector<double>& shares : of_wheel) medians.push_back(median(std::move(shares)));
  const double usual = median(medians);
  if (!(usual > 0.0)) return std::nullopt;
  for (double& share : medians) share /= usual;
  return medians;
}

void bound_by_measured_rates(const DriveCampaign& campaign, std::vector<sim::EffectVariant>& variants) {
  const auto measured = measured_rate_shares(campaign);
  if (!measured) return;
  for (sim::EffectVariant& variant : variants) {
    const sim::Effect* const effect = sim::find_effect(variant.effect);
    if (effect == nullptr || effect->rate_field.empty()) continue;
    const auto wheel = std::find_if(variant.fixed.begin(), variant.fixed.end(),
                                    [&](const auto& held) { return held.first == effect->wheel_field; });
    if (wheel == variant.fixed.end()) continue;
    const auto k = static_cast<std::size_t>(std::lround(wheel->second));
    for (sim::EffectVariant::Free& free : variant.free)
      if (free.field == effect->rate_field && k < measured->size())
        free.lowest = std::clamp((*measured)[k] / campaign.rover->wheels[k].rate_share - kRateError,
                                 free.lowest, free.highest - kRateError);
  }
}

}  // namespace slipway::gap
