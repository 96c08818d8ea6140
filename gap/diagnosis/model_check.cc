#include "gap/diagnosis/model_check.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <string>

#include "core/angle.h"
#include "core/normal_interval.h"
#include "core/quantile.h"
#include "gap/diagnosis/model/drive_resampling.h"
#include "gap/diagnosis/model/hypothesis.h"
#include "gap/diagnosis/search/prepared_campaign.h"
#include "sim/effects/effect_catalogue.h"

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

ChannelCheck score_of(std::span<const PredictedValue> predicted, Channel channel, SlopeClass slope,
                      const ModelCheckOptions& options) {
  ChannelCheck check;
  check.channel = channel;
  check.slope = slope;
  std::map<std::size_t, Errors> by_group;
  Errors all;
  double within_50 = 0.0, within_90 = 0.0;
  for (const PredictedValue& t : predicted) {
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
  if (groups.size() >= kMinDrives)
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

// Effects of the model of which something is left open, as a hypothesis has them: around what they are.
// Those of sensors are not carried over.
std::vector<EffectVariant> open_effects(const CorrectedBelief& belief) {
  std::vector<EffectVariant> variants;
  for (const sim::EffectSetting& setting : belief.rover->effects) {
    const sim::Effect* const effect = sim::find_effect(setting.name);
    if (effect == nullptr || effect->shown_tilt != nullptr) continue;
    EffectVariant variant{.effect = setting.name, .label = "", .free = {}, .fixed = {}};
    for (const auto& [field, value] : setting.parameters) {
      const auto place = belief.left_open.place_of(setting.name + "." + field, "");
      const auto row = std::find_if(effect->fields.begin(), effect->fields.end(),
                                    [&field = field](const auto& f) { return f.name == field; });
      if (place && row != effect->fields.end())
        variant.free.push_back({field, belief.left_open.deviation(*place), row->lowest, row->highest});
      else
        variant.fixed.emplace_back(field, value);
    }
    if (!variant.free.empty()) variants.push_back(std::move(variant));
  }
  return variants;
}

// The model itself, as parameters of its hypothesis.
std::vector<double> at_belief(const Hypothesis& hypothesis, const CorrectedBelief& belief) {
  std::vector<double> x = hypothesis.neutral();
  for (std::size_t p = hypothesis.nuisance_count(); p < x.size(); ++p) {
    const Parameter& parameter = hypothesis.parameters()[p];
    for (const sim::EffectSetting& setting : belief.rover->effects)
      if (setting.name == parameter.effect)
        x[p] = setting.parameters.at(parameter.name.substr(parameter.effect.size() + 1));
  }
  return x;
}

// Variance of every observation by what the model leaves open.
Eigen::VectorXd variance_left_open(const Hypothesis& hypothesis, const Eigen::MatrixXd& jacobian,
                                   const CorrectedBelief& belief) {
  const auto parameters = hypothesis.parameters();
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(jacobian.rows(), belief.left_open.covariance.cols());
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    // Nuisances of several soils are called by their soils' names, which differ from campaign to campaign.
    const std::string nuisance = parameters[p].name.substr(0, parameters[p].name.find('/'));
    const std::size_t soil = parameters[p].soil < 0 ? 0 : static_cast<std::size_t>(parameters[p].soil);
    const auto place = belief.left_open.place_of(nuisance, belief.called[soil]);
    if (place)
      columns.col(static_cast<Eigen::Index>(*place)) +=
          jacobian.col(static_cast<Eigen::Index>(p)) / parameters[p].std;
  }
  return (columns * belief.left_open.covariance).cwiseProduct(columns).rowwise().sum().cwiseMax(0.0);
}

// The campaign as if its rover and soils had been the corrected ones.
DriveCampaign with_belief(DriveCampaign campaign, const CorrectedBelief& belief) {
  auto rover = std::make_shared<sim::RoverModel>(*belief.rover);
  // Its motors made these drives too.
  rover->drive.max_wheel_rate_rad_s =
      std::max(rover->drive.max_wheel_rate_rad_s, campaign.rover->drive.max_wheel_rate_rad_s);
  rover->drive.currents_by_format = campaign.rover->drive.currents_by_format;
  campaign.rover = std::move(rover);
  for (std::size_t s = 0; s < campaign.soils.size(); ++s) campaign.soils[s].soil = belief.soils[s].mean;
  return campaign;
}

std::vector<double> predicted_by(const Hypothesis& hypothesis, std::span<const double> x, WindowModel& model,
                                 std::size_t threads) {
  model.start_from(hypothesis.state(x), threads);
  return hypothesis.predict(model, x, threads);
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

std::vector<ChannelCheck> score_predicted(std::span<const PredictedValue> predicted,
                                          const ModelCheckOptions& options) {
  std::vector<ChannelCheck> checks;
  for (std::size_t c = 0; c < channel_count(); ++c)
    for (const SlopeClass slope : kSlopeClasses) {
      const ChannelCheck check = score_of(predicted, static_cast<Channel>(c), slope, options);
      if (check.values > 0) checks.push_back(check);
    }
  return checks;
}

Result<ModelCheck> check_model(const DriveCampaign& campaign, const CorrectedBelief& belief,
                               const ModelCheckOptions& options, Progress& progress) {
  const auto cancelled = [] { return fail(ErrorCode::kCancelled, "the check was cancelled"); };
  progress.report("predicting with the nominal model", 0.1);
  const std::vector<DriveWindow> windows = cut_windows(campaign, options.windows);
  const std::unique_ptr<WindowModel> model =
      window_model_of(campaign, windows, options.preparation, options.threads);
  model->watch(progress);
  const Hypothesis nominal_model(campaign, {});
  const std::vector<double> nominal =
      predicted_by(nominal_model, nominal_model.neutral(), *model, options.threads);
  if (progress.cancelled()) return cancelled();

  progress.report("predicting with the corrected model", 0.3);
  const DriveCampaign as_corrected = with_belief(campaign, belief);
  const Hypothesis hypothesis(as_corrected, open_effects(belief));
  const std::vector<double> x = at_belief(hypothesis, belief);
  const std::vector<double> corrected = predicted_by(hypothesis, x, *model, options.threads);
  if (progress.cancelled()) return cancelled();

  progress.report("how sure the corrected model is", 0.5);
  const Eigen::MatrixXd jacobian = hypothesis.scaled_jacobian(*model, x, options.threads);
  NoiseModel noise(
      *model,
      scatter_response(hypothesis, jacobian,
                       lever_responses(as_corrected, *model, x, options.discrepancy, options.threads)),
      finite_or_zero(corrected), answerable(*model));
  if (progress.cancelled()) return cancelled();
  noise.set(belief.scatter);
  const Eigen::VectorXd left_open = variance_left_open(hypothesis, jacobian, belief);

  ModelCheck check;
  check.drives = campaign.drives.size();
  const std::vector<std::size_t> groups = repeat_groups(campaign);
  std::vector<PredictedValue> predicted;
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
      predicted.push_back({o.channel, groups[windows[w].drive], model->conditions(w).pitch_rad, o.value,
                           nominal[row], corrected[row],
                           std::hypot(noise.deviation()[at], std::sqrt(left_open[at]))});
    }
  }
  check.values = predicted.size();
  progress.report("resampling drives", 0.9);
  check.channels = score_predicted(predicted, options);
  return check;
}

}  // namespace slipway::gap
