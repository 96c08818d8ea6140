#include "gap/drive_soil_estimation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/normal_interval.h"

namespace slipway::gap {
namespace {

struct Searched {
  SoilParameter parameter;
  std::string_view nuisance;  // its logarithm, in the catalogue
};
// In the order of sim::SoilNormals.
constexpr std::array<Searched, sim::kSoilDims> kSearched{{{SoilParameter::kBekker, "stiffness"},
                                                          {SoilParameter::kN, "n"},
                                                          {SoilParameter::kCohesion, "cohesion"},
                                                          {SoilParameter::kFrictionAngle, "friction"},
                                                          {SoilParameter::kShearModulus, "shear_modulus"}}};

std::optional<std::size_t> place_of(const FittedExplanation& fit, std::string_view nuisance,
                                    const std::string& soil) {
  const auto parameters = fit.hypothesis.parameters();
  for (std::size_t p = 0; p < fit.hypothesis.nuisance_count(); ++p)
    if (parameters[p].name == nuisance || parameters[p].name == fmt::format("{}/{}", nuisance, soil))
      return p;
  return std::nullopt;
}

class SoilOfDrives {
 public:
  SoilOfDrives(const DriveCampaign& campaign, const PreparedCampaign& prepared, std::size_t soil)
      : nominal_(campaign.soils[soil]), fit_(*prepared.null), scales_(prepared.noise->scales()) {
    estimate_.width_m = campaign.rover->wheels.front().width_m;
    estimate_.converged = fit_.converged;
    sim::SoilDistribution& posterior = estimate_.soil;
    posterior.name = nominal_.name;
    posterior.mean = nominal_.soil;
    posterior.assumed = {"correlation_length_m"};
    for (const Nuisance& row : nuisance_catalogue())
      if (const auto p = place_of(fit_, row.name, nominal_.name); p && row.on_soil != nullptr)
        row.on_soil(fit_.x[*p], posterior.mean);
    for (std::size_t q = 0; q < kSearched.size(); ++q)
      places_[q] = place_of(fit_, kSearched[q].nuisance, nominal_.name);
    spread();
    for (std::size_t q = 0; q < kSearched.size(); ++q)
      if (places_[q]) describe(q);
    correlate();
  }
  SoilEstimate take() { return std::move(estimate_); }

 private:
  // Posterior, of the logarithm.
  double deviation(std::size_t quantity) const {
    if (!places_[quantity]) return 0.0;
    const auto p = static_cast<Eigen::Index>(*places_[quantity]);
    return std::sqrt(fit_.covariance(p, p)) * fit_.hypothesis.parameters()[*places_[quantity]].std;
  }
  // With what differs from drive to drive.
  double total(std::size_t quantity) const {
    const std::array<double, sim::kSoilDims> of_drives{scales_.stiffness, 0.0, 0.0, scales_.friction,
                                                       scales_.shear_modulus};
    return std::min(1.0, std::hypot(deviation(quantity), of_drives[quantity]));
  }

  void spread() {
    sim::SoilDistribution& soil = estimate_.soil;
    const double angle = soil.mean.friction_angle_rad;
    soil.std.stiffness_ratio = total(0);
    soil.std.n = std::min(1.0, soil.mean.pressure.n * total(1));
    soil.std.cohesion_pa = soil.mean.cohesion_pa * total(2);
    soil.std.friction_angle_rad = std::min(0.5, std::sin(angle) * std::cos(angle) * total(3));
    soil.std.shear_modulus_ratio = total(4);
    for (int a = 0; a < sim::kSoilDims; ++a)
      for (int b = 0; b < sim::kSoilDims; ++b) {
        const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
        if (a == b || !places_[i] || !places_[j]) continue;
        const double both = covariance(i, j);
        soil.correlation(a, b) = both / (total(i) * total(j));
      }
  }
  double covariance(std::size_t i, std::size_t j) const {
    const auto parameters = fit_.hypothesis.parameters();
    return fit_.covariance(static_cast<Eigen::Index>(*places_[i]), static_cast<Eigen::Index>(*places_[j])) *
           parameters[*places_[i]].std * parameters[*places_[j]].std;
  }

  void describe(std::size_t quantity) {
    const Parameter& searched = fit_.hypothesis.parameters()[*places_[quantity]];
    const double at = fit_.x[*places_[quantity]], error = deviation(quantity);
    EstimatedParameter p;
    p.parameter = kSearched[quantity].parameter;
    const auto value_at = [&](double logarithm) {
      sim::Soil soil = nominal_.soil;
      for (const Nuisance& row : nuisance_catalogue())
        if (row.name == kSearched[quantity].nuisance) row.on_soil(logarithm, soil);
      return value_of(p.parameter, soil, estimate_.width_m);
    };
    const auto slope_at = [&](double logarithm) {
      constexpr double kStep = 1e-4;
      return (value_at(logarithm + kStep) - value_at(logarithm - kStep)) / (2.0 * kStep);
    };
    p.start = value_at(0.0);
    p.value = value_at(at);
    p.std = slope_at(at) * error;
    p.prior_std = slope_at(0.0) * searched.std;
    p.on_bound = at <= searched.lowest || at >= searched.highest;
    const double left = 1.0 - std::pow(error / searched.std, 2);
    const double alone = left > 1e-4 ? error / std::sqrt(left) : 100.0 * error;
    const double low = at - kReach90 * alone, high = at + kReach90 * alone;
    p.low_open = low <= searched.lowest;
    p.high_open = high >= searched.highest;
    p.low = value_at(std::max(low, searched.lowest));
    p.high = value_at(std::min(high, searched.highest));
    judge(p, {.says_more = error < kOfPrior * searched.std});
    estimate_.parameters.push_back(std::move(p));
  }

  void correlate() {
    std::vector<std::size_t> shown;
    for (std::size_t q = 0; q < kSearched.size(); ++q)
      if (places_[q]) shown.push_back(q);
    const auto n = static_cast<Eigen::Index>(shown.size());
    estimate_.correlation = Eigen::MatrixXd::Identity(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) {
        const std::size_t a = shown[static_cast<std::size_t>(i)], b = shown[static_cast<std::size_t>(j)];
        if (a != b) estimate_.correlation(i, j) = covariance(a, b) / (deviation(a) * deviation(b));
      }
  }

  static constexpr double kOfPrior = 0.7;

  const NominalSoil& nominal_;
  const FittedExplanation& fit_;
  const NoiseScales& scales_;
  std::array<std::optional<std::size_t>, sim::kSoilDims> places_;
  SoilEstimate estimate_;
};

std::vector<DriveChannelResidual> left_over(const PreparedCampaign& prepared) {
  std::vector<DriveChannelResidual> channels;
  const NoiseModel& noise = *prepared.noise;
  for (int c = 0; c < kChannels; ++c) {
    DriveChannelResidual channel{static_cast<Channel>(c), 0, 0.0, 0.0};
    for (std::size_t w = 0; w < prepared.windows.size(); ++w)
      for (std::size_t i = 0; i < prepared.windows[w].observations.size(); ++i) {
        const std::size_t row = prepared.model->offset(w) + i;
        if (!noise.used()[row] || prepared.windows[w].observations[i].channel != channel.channel) continue;
        const double r = prepared.null->residuals[static_cast<Eigen::Index>(row)];
        ++channel.count;
        channel.rms += r * r;
        channel.rms_deviations += std::pow(r / noise.deviation()[static_cast<Eigen::Index>(row)], 2);
      }
    if (channel.count == 0) continue;
    channel.rms = std::sqrt(channel.rms / static_cast<double>(channel.count));
    channel.rms_deviations = std::sqrt(channel.rms_deviations / static_cast<double>(channel.count));
    channels.push_back(channel);
  }
  return channels;
}

bool any_reading(const DriveCampaign& campaign, const std::array<bool, kChannels>& looked_at) {
  for (const DriveWindow& window : cut_windows(campaign))
    for (const Observation& o : window.observations)
      if (looked_at[static_cast<std::size_t>(o.channel)]) return true;
  return false;
}

}  // namespace

Result<DriveSoilEstimate> estimate_soils_of_drives(const DriveCampaign& campaign,
                                                   const std::array<bool, kChannels>& looked_at,
                                                   std::size_t threads, Progress& progress) {
  if (!any_reading(campaign, looked_at))
    return fail(ErrorCode::kNoData, "the drives have no reading of the channels that are looked at");
  const auto prepared = prepare(campaign, WindowOptions{}, threads, progress, looked_at);
  if (!prepared) return fail(prepared.error());
  DriveSoilEstimate estimate;
  for (std::size_t s = 0; s < campaign.soils.size(); ++s)
    estimate.soils.push_back(SoilOfDrives(campaign, *prepared, s).take());
  estimate.channels = left_over(*prepared);
  estimate.windows = prepared->used_windows();
  return estimate;
}

}  // namespace slipway::gap
