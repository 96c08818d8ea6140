#include "gap/model_check.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/angle.h"
#include "core/normal_interval.h"
#include "core/quantile.h"
#include "gap/drive_resampling.h"
#include "gap/hypothesis.h"
#include "gap/prepared_campaign.h"

namespace slipway::gap {
namespace {

bool is_of(SlopeClass slope, double gradient_rad) {
  const double steep = rad_from_deg(kLevelWithin_deg);
  switch (slope) {
    case SlopeClass::kAll:
      return true;
    case SlopeClass::kUp:
      return gradient_rad > steep;
    case SlopeClass::kLevel:
      return std::abs(gradient_rad) <= steep;
    case SlopeClass::kDown:
      return gradient_rad < -steep;
  }
  return false;
}

// Errors of both models in some values.
struct Errors {
  std::vector<double> nominal, corrected;

  void add(const Errors& other) {
    nominal.insert(nominal.end(), other.nominal.begin(), other.nominal.end());
    corrected.insert(corrected.end(), other.corrected.begin(), other.corrected.end());
  }
};

double rms(const std::vector<double>& errors) {
  double sum = 0.0;
  for (const double e : errors) sum += e * e;
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

double median_magnitude(std::vector<double> errors) {
  for (double& e : errors) e = std::abs(e);
  return quantile(std::move(errors), 0.5);
}

// Where the nominal model is exact, nothing can be brought down.
double percent_down(double nominal, double corrected) {
  return nominal > 0.0 ? 100.0 * (1.0 - corrected / nominal) : 0.0;
}

template <class Statistic>
ErrorChange change_of(const Errors& all, const std::vector<Errors>& resampled, const Statistic& statistic) {
  ErrorChange change{statistic(all.nominal), statistic(all.corrected), 0.0, {}};
  change.down_percent = percent_down(change.nominal, change.corrected);
  if (resampled.empty()) return change;
  std::vector<double> down;
  for (const Errors& e : resampled)
    down.push_back(percent_down(statistic(e.nominal), statistic(e.corrected)));
  change.down_interval = Interval{change.down_percent, quantile(down, 0.05), quantile(down, 0.95)};
  return change;
}

ChannelCheck score_of(std::span<const ToldValue> told, Channel channel, SlopeClass slope,
                      const ModelCheckOptions& options) {
  ChannelCheck check;
  check.channel = channel;
  check.slope = slope;
  std::map<std::size_t, Errors> by_group;
  Errors all;
  double within_50 = 0.0, within_90 = 0.0;
  for (const ToldValue& t : told) {
    if (t.channel != channel || !is_of(slope, t.gradient_rad)) continue;
    const double error = t.corrected - t.measured;
    const Errors one{{t.nominal - t.measured}, {error}};
    by_group[t.group].add(one);
    all.add(one);
    within_50 += std::abs(error) <= kReach50 * t.deviation ? 1.0 : 0.0;
    within_90 += std::abs(error) <= kReach90 * t.deviation ? 1.0 : 0.0;
  }
  check.values = all.nominal.size();
  check.drives = by_group.size();
  if (check.values == 0) return check;
  std::vector<const Errors*> groups;
  for (const auto& [group, errors] : by_group) groups.push_back(&errors);
  std::vector<Errors> resampled;
  if (groups.size() >= kLeastDrives)
    for (const auto& picks : resampled_indices(groups.size(), options.resamples, options.seed)) {
      resampled.emplace_back();
      for (const std::size_t pick : picks) resampled.back().add(*groups[pick]);
    }
  check.rms = change_of(all, resampled, rms);
  check.median = change_of(all, resampled, median_magnitude);
  check.within_50 = within_50 / static_cast<double>(check.values);
  check.within_90 = within_90 / static_cast<double>(check.values);
  return check;
}

// What the estimate leaves open of a soil, as deviations of the nuisances of these names. The model's spread
// has the scatter from drive to drive in it, which the noise model adds by itself.
struct SoilDeviation {
  std::string_view nuisance;
  double deviation = 0.0;
};
std::array<SoilDeviation, 5> left_open(const sim::SoilDistribution& soil, const NoiseScales& scatter) {
  const auto without = [](double whole, double of_drives) {
    return std::sqrt(std::max(0.0, whole * whole - of_drives * of_drives));
  };
  const auto relative = [](double deviation, double mean) { return mean > 0.0 ? deviation / mean : 0.0; };
  const double angle = soil.mean.friction_angle_rad;
  return {SoilDeviation{"stiffness", without(soil.std.stiffness_ratio, scatter.stiffness)},
          SoilDeviation{"n", relative(soil.std.n, soil.mean.pressure.n)},
          SoilDeviation{"cohesion", relative(soil.std.cohesion_pa, soil.mean.cohesion_pa)},
          SoilDeviation{"friction",
                        without(relative(soil.std.friction_angle_rad, std::sin(angle) * std::cos(angle)),
                                scatter.friction)},
          SoilDeviation{"shear_modulus", without(soil.std.shear_modulus_ratio, scatter.shear_modulus)}};
}

// Variance of every observation by what the estimate leaves open of the soils.
Eigen::VectorXd soil_variance(const Hypothesis& hypothesis, const Eigen::MatrixXd& jacobian,
                              const DriveCampaign& corrected, const CorrectedBelief& belief) {
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(jacobian.rows());
  const auto parameters = hypothesis.parameters();
  for (std::size_t s = 0; s < belief.soils.size(); ++s)
    for (const SoilDeviation& d : left_open(belief.soils[s], belief.scatter))
      for (std::size_t p = 0; p < parameters.size(); ++p) {
        const bool is_it = parameters[p].name == d.nuisance ||
                           parameters[p].name == std::string(d.nuisance) + "/" + corrected.soils[s].name;
        if (is_it && parameters[p].effect.empty())
          variance +=
              (jacobian.col(static_cast<Eigen::Index>(p)) * (d.deviation / parameters[p].std)).cwiseAbs2();
      }
  return variance;
}

// The campaign as if its rover and soils had been the corrected ones.
DriveCampaign with_belief(DriveCampaign campaign, const CorrectedBelief& belief) {
  auto rover = std::make_shared<sim::RoverModel>(*belief.rover);
  // Its motors made these drives too.
  rover->drive.max_wheel_rate_rad_s =
      std::max(rover->drive.max_wheel_rate_rad_s, campaign.rover->drive.max_wheel_rate_rad_s);
  campaign.rover = std::move(rover);
  for (std::size_t s = 0; s < campaign.soils.size(); ++s) campaign.soils[s].soil = belief.soils[s].mean;
  return campaign;
}

std::vector<double> predicted_by(const Hypothesis& hypothesis, WindowModel& model, std::size_t threads) {
  const std::vector<double> neutral = hypothesis.neutral();
  model.start_from(hypothesis.state(neutral), threads);
  return hypothesis.predict(model, neutral, threads);
}

std::vector<double> finite_or_zero(std::vector<double> values) {
  for (double& value : values)
    if (!std::isfinite(value)) value = 0.0;
  return values;
}

// Rows of windows that have ground.
std::vector<bool> answerable(const WindowModel& model) {
  std::vector<bool> rows(model.observation_count(), false);
  for (std::size_t w = 0; w < model.windows().size(); ++w)
    if (model.used(w))
      std::fill_n(rows.begin() + static_cast<std::ptrdiff_t>(model.offset(w)),
                  model.windows()[w].observations.size(), true);
  return rows;
}

}  // namespace

std::string_view name_of(SlopeClass slope) {
  constexpr std::array<std::string_view, kSlopeClasses.size()> kNames{"all", "up", "level", "down"};
  return kNames[static_cast<std::size_t>(slope)];
}

std::vector<ChannelCheck> score_told(std::span<const ToldValue> told, const ModelCheckOptions& options) {
  std::vector<ChannelCheck> checks;
  for (int c = 0; c < kChannels; ++c)
    for (const SlopeClass slope : kSlopeClasses) {
      const ChannelCheck check = score_of(told, static_cast<Channel>(c), slope, options);
      if (check.values > 0) checks.push_back(check);
    }
  return checks;
}

Result<ModelCheck> check_model(const DriveCampaign& campaign, const CorrectedBelief& belief,
                               const ModelCheckOptions& options, Progress& progress) {
  const auto cancelled = [] { return fail(ErrorCode::kCancelled, "the check was cancelled"); };
  progress.report("predicting with the nominal model", 0.1);
  const std::vector<DriveWindow> windows = cut_windows(campaign, options.windows);
  const std::unique_ptr<WindowModel> model = window_model_of(campaign, windows);
  model->watch(progress);
  const std::vector<double> nominal = predicted_by(Hypothesis(campaign, {}), *model, options.threads);
  if (progress.cancelled()) return cancelled();

  progress.report("predicting with the corrected model", 0.3);
  const DriveCampaign as_corrected = with_belief(campaign, belief);
  const Hypothesis hypothesis(as_corrected, {});
  const std::vector<double> corrected = predicted_by(hypothesis, *model, options.threads);
  if (progress.cancelled()) return cancelled();

  progress.report("how sure the corrected model is", 0.5);
  const std::vector<double> neutral = hypothesis.neutral();
  const Eigen::MatrixXd jacobian = hypothesis.scaled_jacobian(*model, neutral, options.threads);
  NoiseModel noise(
      *model,
      scatter_response(hypothesis, jacobian, lever_responses(as_corrected, *model, neutral, options.threads)),
      finite_or_zero(corrected), answerable(*model));
  if (progress.cancelled()) return cancelled();
  noise.set(belief.scatter);
  const Eigen::VectorXd of_soils = soil_variance(hypothesis, jacobian, as_corrected, belief);

  ModelCheck check;
  check.drives = campaign.drives.size();
  const std::vector<std::size_t> groups = repeat_groups(campaign);
  std::vector<ToldValue> told;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    if (!model->used(w)) continue;
    ++check.windows;
    for (std::size_t i = 0; i < windows[w].observations.size(); ++i) {
      const Observation& o = windows[w].observations[i];
      // Of a slip beyond the censoring it is known only that it was so great.
      if (windows[w].censored && o.channel == Channel::kSlip) continue;
      const std::size_t row = model->offset(w) + i;
      check.unanswered_nominal += std::isfinite(nominal[row]) ? 0 : 1;
      check.unanswered_corrected += std::isfinite(corrected[row]) ? 0 : 1;
      if (!std::isfinite(nominal[row]) || !std::isfinite(corrected[row])) continue;
      const auto at = static_cast<Eigen::Index>(row);
      told.push_back({o.channel, groups[windows[w].drive], model->conditions(w).pitch_rad, o.value,
                      nominal[row], corrected[row],
                      std::hypot(noise.deviation()[at], std::sqrt(of_soils[at]))});
    }
  }
  check.values = told.size();
  progress.report("resampling drives", 0.9);
  check.channels = score_told(told, options);
  return check;
}

}  // namespace slipway::gap
