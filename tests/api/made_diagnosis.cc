#include "made_diagnosis.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "api/files/campaign/drive_campaign_source.h"
#include "gap/diagnosis/model/hypothesis.h"

namespace slipway::api::testing {

gap::DriveCampaign practice_campaign() {
  auto campaign =
      load_drive_campaign(std::filesystem::path(SLIPWAY_DATA_FOLDER) / "gap-practice/p05", Catalogue{});
  if (!campaign) throw std::runtime_error(campaign.error().detail);
  return std::move(*campaign);
}

gap::Diagnosis full_diagnosis(const gap::DriveCampaign& campaign) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  gap::Diagnosis d;
  d.campaign = campaign.name;
  d.campaign_fingerprint = campaign.fingerprint;
  d.nominal_rover = campaign.rover;
  d.nominal_soils = campaign.soils;
  d.options = gap::listed_options({});
  d.library = {"motor_temperature", "soft_patch"};
  d.verdict = gap::Verdict::kEffects;
  d.reason = "made up";
  d.overturned_by = "a look at the code";
  d.candidates = {{{"motor_temperature"}, 0.5, 1.5, 2},
                  {{"grousers"}, 0.2, kNan, 1},
                  {{"motor_temperature"}, 0.1, std::nullopt, 2},
                  {{"grousers"}, 0.1, std::nullopt, 1, 0.0, true}};
  d.marginals = {{"grousers", 0.97, 0.8}, {"bulldozing", 0.2, 0.0}};
  d.confusable = {{"bulldozing", "grousers", 12.0}};
  d.look_alikes = {{"bulldozing", "parameters", {"exit_angle"}, 4.0}, {"bulldozing", "grousers", {}, 12.0}};
  d.candidates[0].log_evidence = 12.5;
  d.candidates[0].log_prior = -3.0;
  d.measurements = {{"hardpan",
                     {gap::NuisanceKind::kSoil, gap::NuisanceKind::kClosure},
                     {"stiffness", "n", "c1"},
                     1.2,
                     7.5}};
  d.channels = {{gap::Channel::kYawRate, std::nullopt, 0.01, 0.005, -0.001, 0.01},
                {gap::Channel::kCurrent, "lf", 0.04, kNan, 0.03, 0.002}};
  d.regimes = {{{{gap::WindowVariable::kSlope, 5.0, kInfinite}}, gap::Channel::kSlip, 0.7, 0.2, 0.01}};
  d.regimes_retuned = d.regimes_of_effect = d.regimes;
  d.channels_of_effects = {{gap::Channel::kCurrent, 0.75}, {gap::Channel::kSlip, 0.25}};
  d.places = {{campaign.terrains.front().name, 3.0, -2.0, 1.5, gap::Channel::kSlip, 0.4}};
  d.gap = {{gap::Channel::kPitch,
            {0.03, 0.02, 0.04},
            {0.02, 0.01, 0.03},
            {0.01, 0.0, 0.02},
            {0.01, 0.01, 0.01},
            gap::Interval{0.8, 0.6, 1.0},
            gap::Interval{0.0095, 0.0, 0.015}}};
  d.reference = gap::ReferenceSummary{"last_year", "0a1b", 20, 80, {{gap::Channel::kPitch, 0.012, 0.002}}};
  d.closed_fraction = gap::Interval{0.9, 0.7, 1.1};
  d.held_out = {{gap::Channel::kSlip, -1, 0, 2.0, 0.1, 0.2, 0.15, kNan}};
  d.window_gaps = {{0, 0, 2.0, {{3.0, -2.0, 0.0}, {3.5, -2.0, 0.0}}, 4.5, 2.0, kNan}};
  d.residual = {{"wheel_load", "temperature", 0.6, {{-1.0, {0.2, 0.1, 0.3}}, {1.0, {kNan, 0.0, 0.0}}}}};
  d.next_drives = {{15.0, 90.0, 0.04, 0.3, -20.0, 1.2}};
  gap::ResidualShape& pull = d.residual.emplace_back();
  pull.entry = "tangential_force";
  pull.variable = "direction";
  pull.form = "force_on_body";
  pull.words = "a steady pull of 25 N against the travel, at the body";
  pull.unit = "N";
  pull.probability = 0.9;
  pull.closed_share = 0.4;
  pull.parameters = {{"force_n", {-25.0, -27.0, -23.0}}};
  pull.shape = {{-1.0, {25.0, 23.0, 27.0}}, {1.0, {-25.0, -27.0, -23.0}}};
  d.least_detectable = {{"grousers", "height_m", 0.01}, {"bulldozing", "share", kInfinite}};
  d.notes = {"a | note\nof two lines"};
  d.drives = 44;

  std::vector<gap::EffectVariant> effects;
  for (gap::EffectVariant& v : gap::effect_variants(*campaign.rover, {}))
    if (v.effect == "motor_temperature" || v.effect == "slip_sinkage") effects.push_back(std::move(v));
  const gap::Hypothesis hypothesis(campaign, std::move(effects));
  std::vector<double> x;
  for (const gap::Parameter& p : hypothesis.parameters())
    x.push_back(std::clamp(p.neutral + 0.3 * p.std, p.lowest, p.highest));
  for (std::size_t k = 0; k < hypothesis.nuisance_count(); ++k) {
    const gap::Parameter& p = hypothesis.parameters()[k];
    d.retuned.push_back({p.name, {x[k], x[k] - 0.1 * p.std, x[k] + 0.1 * p.std}, p.std, true});
  }
  // Of all parameters a tenth of the prior is left open; stiffness and exponent are anti-correlated.
  const auto count = static_cast<Eigen::Index>(hypothesis.parameters().size());
  d.left_open.covariance = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index p = 0; p < count; ++p) {
    const gap::Parameter& parameter = hypothesis.parameters()[static_cast<std::size_t>(p)];
    d.left_open.names.push_back(parameter.name);
    d.left_open.covariance(p, p) = std::pow(0.1 * parameter.std, 2);
  }
  d.left_open.covariance(0, 1) = d.left_open.covariance(1, 0) =
      -0.5 * d.left_open.deviation(0) * d.left_open.deviation(1);
  d.model = hypothesis.state(x);
  d.model_effects = hypothesis.settings(x);
  for (const sim::EffectSetting& setting : d.model_effects) {
    gap::FoundEffect found{setting.name, "", 0.9, {}};
    for (const auto& [field, value] : setting.parameters)
      found.parameters.push_back({field, {value, value, value}});
    d.effects.push_back(std::move(found));
  }
  return d;
}

const gap::DriveCampaign& WithFullDiagnosis::campaign() {
  static const gap::DriveCampaign loaded = practice_campaign();
  return loaded;
}

const gap::Diagnosis& WithFullDiagnosis::diagnosis() {
  static const gap::Diagnosis made = full_diagnosis(campaign());
  return made;
}

}  // namespace slipway::api::testing
