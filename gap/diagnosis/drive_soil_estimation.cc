#include "gap/diagnosis/drive_soil_estimation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/normal_interval.h"
#include "gap/diagnosis/search/parameter_posterior.h"

namespace slipway::gap {
namespace {

// What kSoilNuisances are the logarithms of.
constexpr std::array<SoilParameter, sim::kSoilDims> kSoilSearched{
    SoilParameter::kBekker, SoilParameter::kN, SoilParameter::kCohesion, SoilParameter::kFrictionAngle,
    SoilParameter::kShearModulus};

std::optional<std::size_t> place_of(const FittedExplanation& fit, std::string_view nuisance,
                                    const std::string& soil) {
  const auto parameters = fit.hypothesis.parameters();
  for (std::size_t p = 0; p < fit.hypothesis.nuisance_count(); ++p)
    if (is_nuisance(parameters[p].name, nuisance, soil)) return p;
  return std::nullopt;
}

class SoilOfDrives {
 public:
  SoilOfDrives(const DriveCampaign& campaign, const PreparedCampaign& prepared, std::size_t soil)
      : nominal_(campaign.soils[soil]), fit_(*prepared.null), posterior_(posterior_of(fit_)) {
    estimate_.width_m = campaign.rover->wheels.front().width_m;
    estimate_.converged = fit_.converged;
    sim::SoilDistribution& posterior = estimate_.soil;
    posterior.name = nominal_.name;
    posterior.mean = nominal_.soil;
    posterior.assumed = {"correlation_length_m"};
    for (const Nuisance& row : nuisance_catalogue())
      if (const auto p = place_of(fit_, row.name, nominal_.name); p && row.on_soil != nullptr)
        row.on_soil(fit_.x[*p], posterior.mean);
    for (std::size_t q = 0; q < kSoilSearched.size(); ++q)
      places_[q] = place_of(fit_, kSoilNuisances[q], nominal_.name);
    set_spread(posterior_, prepared.noise->scales(), posterior);
    for (std::size_t q = 0; q < kSoilSearched.size(); ++q)
      if (places_[q]) describe(q);
    correlate();
  }
  SoilEstimate take() { return std::move(estimate_); }

 private:
  // Posterior, of the logarithm.
  double deviation(std::size_t quantity) const {
    return posterior_.deviation(*posterior_.place_of(kSoilNuisances[quantity], nominal_.name));
  }
  double covariance(std::size_t a, std::size_t b) const {
    return posterior_.covariance(
        static_cast<Eigen::Index>(*posterior_.place_of(kSoilNuisances[a], nominal_.name)),
        static_cast<Eigen::Index>(*posterior_.place_of(kSoilNuisances[b], nominal_.name)));
  }

  void describe(std::size_t quantity) {
    const Parameter& searched = fit_.hypothesis.parameters()[*places_[quantity]];
    const double at = fit_.x[*places_[quantity]], error = deviation(quantity);
    EstimatedParameter p;
    p.parameter = kSoilSearched[quantity];
    const auto value_at = [&](double logarithm) {
      sim::Soil soil = nominal_.soil;
      for (const Nuisance& row : nuisance_catalogue())
        if (row.name == kSoilNuisances[quantity]) row.on_soil(logarithm, soil);
      return value_of(kSoilSearched[quantity], soil, estimate_.width_m);
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
    const DeterminationOptions determination;
    judge(p, {.says_more = error < determination.max_of_prior * searched.std}, determination);
    estimate_.parameters.push_back(std::move(p));
  }

  void correlate() {
    std::vector<std::size_t> shown;
    for (std::size_t q = 0; q < kSoilSearched.size(); ++q)
      if (places_[q]) shown.push_back(q);
    const auto n = static_cast<Eigen::Index>(shown.size());
    estimate_.correlation = Eigen::MatrixXd::Identity(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) {
        const std::size_t a = shown[static_cast<std::size_t>(i)], b = shown[static_cast<std::size_t>(j)];
        if (a != b) estimate_.correlation(i, j) = covariance(a, b) / (deviation(a) * deviation(b));
      }
  }

  const NominalSoil& nominal_;
  const FittedExplanation& fit_;
  ParameterPosterior posterior_;
  std::array<std::optional<std::size_t>, sim::kSoilDims> places_;
  SoilEstimate estimate_;
};

std::vector<DriveChannelResidual> left_over(const PreparedCampaign& prepared) {
  std::vector<DriveChannelResidual> channels;
  const NoiseModel& noise = *prepared.noise;
  for (std::size_t c = 0; c < channel_count(); ++c) {
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

bool any_reading(const DriveCampaign& campaign, const std::vector<bool>& looked_at) {
  for (const DriveWindow& window : cut_windows(campaign))
    for (const Observation& o : window.observations)
      if (looked_at.empty() || looked_at[static_cast<std::size_t>(o.channel)]) return true;
  return false;
}

}  // namespace

Result<DriveSoilEstimate> estimate_soils_of_drives(const DriveCampaign& campaign,
                                                   const std::vector<bool>& looked_at, std::size_t threads,
                                                   Progress& progress) {
  if (!any_reading(campaign, looked_at))
    return fail(ErrorCode::kNoData, "the drives have no reading of the channels that are looked at");
  DiagnosisOptions options;
  options.search.threads = threads;
  const auto prepared = prepare(campaign, options, progress, looked_at);
  if (!prepared) return fail(prepared.error());
  DriveSoilEstimate estimate;
  for (std::size_t s = 0; s < campaign.soils.size(); ++s)
    estimate.soils.push_back(SoilOfDrives(campaign, *prepared, s).take());
  estimate.channels = left_over(*prepared);
  estimate.windows = prepared->used_windows();
  return estimate;
}

}  // namespace slipway::gap
