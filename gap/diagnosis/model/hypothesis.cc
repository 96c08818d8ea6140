#include "gap/diagnosis/model/hypothesis.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "core/parallel_for.h"
#include "gap/diagnosis/model/reference_belief.h"
#include "gap/diagnosis/model/turned_motion.h"

namespace slipway::gap {
namespace {

using Free = EffectVariant::Free;

// The step of a derivative, over the parameter's std.
constexpr double kDerivativeStep = 0.05;
// Share of its usual std that a nuisance has where it is held at its nominal value.
constexpr double kHeld = 1e-3;

// The rover's own setting of an effect, where it is on.
const sim::EffectSetting* own_setting(const sim::RoverModel& rover, std::string_view effect) {
  for (const sim::EffectSetting& own : rover.effects)
    if (own.on && own.name == effect) return &own;
  return nullptr;
}

// An effect is on once: where the rover has it already, the only other model is one of another size, with
// all else as the rover has it.
EffectVariant of_another_size(const sim::Effect& effect, const sim::EffectSetting& own,
                              const EffectVariant& usual) {
  EffectVariant variant{
      .effect = "", .label = "of another size than the rover file's", .free = usual.free, .fixed = {}};
  const std::vector<double> values = sim::values_of(effect, own);
  for (std::size_t i = 0; i < effect.fields.size(); ++i)
    if (std::none_of(usual.free.begin(), usual.free.end(),
                     [&](const Free& free) { return free.field == effect.fields[i].name; }))
      variant.fixed.emplace_back(effect.fields[i].name, values[i]);
  return variant;
}

// Motion along a heading that is recorded `lag_s` later.
void turn_by_lag(const WindowModel& model, double lag_s, std::vector<double>& predicted) {
  for (std::size_t w = 0; w < model.windows().size(); ++w) {
    const DriveWindow& window = model.windows()[w];
    double yaw_rate = window.command.speed_m_s * window.command.curvature_1_m;
    for (std::size_t i = 0; i < window.observations.size(); ++i) {
      const double value = predicted[model.offset(w) + i];
      if (window.observations[i].channel == Channel::kYawRate && std::isfinite(value)) yaw_rate += value;
    }
    read_along_turned_heading(model, w, yaw_rate * lag_s, predicted);
  }
}

}  // namespace

std::vector<EffectVariant> effect_variants(const sim::RoverModel& rover,
                                           std::span<const std::string> withheld) {
  std::vector<EffectVariant> all;
  for (const sim::Effect& effect : sim::effect_catalogue()) {
    if (std::find(withheld.begin(), withheld.end(), effect.name) != withheld.end()) continue;
    std::vector<EffectVariant> variants =
        effect.variants != nullptr ? effect.variants(rover) : std::vector{sim::variant_of_fields(effect)};
    if (const auto* const own = own_setting(rover, effect.name); own != nullptr && !variants.empty())
      variants = {of_another_size(effect, *own, variants.front())};
    for (EffectVariant& v : variants) {
      v.effect = effect.name;
      all.push_back(std::move(v));
    }
  }
  return all;
}

EffectVariant variant_at(const sim::Effect& effect, const sim::Disc& place) {
  EffectVariant variant = effect.variant_at(place);
  variant.effect = effect.name;
  return variant;
}

std::optional<sim::Disc> place_of(const EffectVariant& variant) {
  const sim::Effect* const effect = sim::find_effect(variant.effect);
  if (effect == nullptr || effect->region == nullptr) return std::nullopt;
  const sim::EffectSetting setting{variant.effect, {variant.fixed.begin(), variant.fixed.end()}};
  return effect->region(sim::values_of(*effect, setting));
}

Hypothesis::Hypothesis(const DriveCampaign& campaign, std::vector<EffectVariant> effects,
                       FreeNuisances nuisances)
    : campaign_(&campaign), effects_(std::move(effects)) {
  const bool several = campaign.soils.size() > 1, total_current = currents_split_evenly(campaign);
  for (const Nuisance& row : nuisance_catalogue()) {
    const bool nominal = row.kind == NuisanceKind::kSoil || row.kind == NuisanceKind::kMotor;
    if (nuisances == FreeNuisances::kClosures && nominal) continue;
    if (row.name == kIdleCurrent && !total_current) continue;
    const bool wide = total_current && row.name == "torque_constant";
    const int copies = row.kind == NuisanceKind::kSoil ? static_cast<int>(campaign.soils.size()) : 1;
    for (int soil = 0; soil < copies; ++soil) {
      std::string name(row.name);
      if (row.kind == NuisanceKind::kSoil && several)
        name += "/" + campaign.soils[static_cast<std::size_t>(soil)].name;
      const bool held = campaign.retuning == Retuning::kNone ||
                        (campaign.retuning == Retuning::kNoClosures && row.kind == NuisanceKind::kClosure);
      const auto stated = campaign.parameter_std.find(row.name);
      const double std = stated != campaign.parameter_std.end() ? stated->second
                         : wide                                 ? kTotalTorqueStd
                                                                : row.std;
      const double farthest = wide ? 3.0 * kTotalTorqueStd : 0.0;
      parameters_.push_back({name, "", 0.0, held ? kHeld * std : std, wide ? kTotalTorqueStd : row.std,
                             std::min(row.lowest, -farthest), std::max(row.highest, farthest),
                             quantity_of(row), row.kind == NuisanceKind::kSoil ? soil : -1, row.kind, false,
                             stated != campaign.parameter_std.end(), held});
      places_.push_back({&row, row.kind == NuisanceKind::kSoil ? soil : -1});
    }
  }
  nuisances_ = parameters_.size();
  believe_reference();
  for (const EffectVariant& v : effects_)
    for (const Free& free : v.free) {
      double neutral = 0.0;  // of a cause from outside
      if (const sim::Effect* const effect = sim::find_effect(v.effect))
        for (const Field& field : effect->fields)
          if (field.name == free.field) neutral = neutral_of(v, field);
      parameters_.push_back(
          {v.effect + "." + free.field, v.effect, neutral, free.std, free.std, free.lowest, free.highest});
      parameters_.back().shape = free.shape;
    }
  if (prior_precision_.size() == 0) return;
  const Eigen::MatrixXd of_nuisances = std::move(prior_precision_);
  const auto all = static_cast<Eigen::Index>(parameters_.size());
  prior_precision_ = Eigen::MatrixXd::Identity(all, all);
  prior_precision_.topLeftCorner(of_nuisances.rows(), of_nuisances.cols()) = of_nuisances;
}

void Hypothesis::believe_reference() {
  if (!campaign_->reference) return;
  const ReferenceBelief& belief = *campaign_->reference;
  std::vector<Eigen::Index> of;
  for (Parameter& parameter : parameters_) {
    of.push_back(static_cast<Eigen::Index>(place_in(belief.names, parameter.name)));
    parameter.neutral = belief.mean[of.back()];
  }
  prior_precision_ = belief.precision(of, of);
}

double Hypothesis::neutral_of(const EffectVariant& variant, const Field& field) const {
  if (const auto* const own = own_setting(*campaign_->rover, variant.effect)) {
    const auto given = own->parameters.find(std::string(field.name));
    return given == own->parameters.end() ? field.initial : given->second;
  }
  for (const Free& free : variant.free)
    if (free.field == field.name && free.neutral) return *free.neutral;
  return field.neutral.value_or(field.initial);
}

std::vector<double> Hypothesis::neutral() const {
  std::vector<double> x;
  for (const Parameter& p : parameters_) x.push_back(p.neutral);
  return x;
}

std::vector<sim::EffectSetting> Hypothesis::settings(std::span<const double> x) const {
  std::vector<sim::EffectSetting> settings = all_settings(x);
  std::erase_if(settings, [](const sim::EffectSetting& s) { return sim::find_effect(s.name) == nullptr; });
  return settings;
}

OutsideValues Hypothesis::outside_values(std::string_view cause, std::span<const double> x) const {
  for (sim::EffectSetting& setting : all_settings(x))
    if (setting.name == cause) return {setting.parameters.begin(), setting.parameters.end()};
  return {};
}

std::vector<sim::EffectSetting> Hypothesis::all_settings(std::span<const double> x) const {
  std::vector<sim::EffectSetting> settings;
  std::size_t at = nuisances_;
  for (const EffectVariant& v : effects_) {
    sim::EffectSetting setting{.name = v.effect, .parameters = {}};
    for (const auto& [field, value] : v.fixed) setting.parameters[field] = value;
    for (const Free& free : v.free) setting.parameters[free.field] = x[at++];
    // Fields that are neither take their neutral value, so that nothing else is at work.
    const sim::Effect* const effect = sim::find_effect(v.effect);
    for (const Field& f : effect != nullptr ? effect->fields : std::span<const Field>{})
      if (f.neutral && std::find(v.at_initial.begin(), v.at_initial.end(), f.name) == v.at_initial.end())
        setting.parameters.try_emplace(std::string(f.name), neutral_of(v, f));
    settings.push_back(std::move(setting));
  }
  return settings;
}

ModelState Hypothesis::state(std::span<const double> x) const {
  if (x.size() != parameters_.size())
    throw std::invalid_argument("Hypothesis::state: one number a parameter");
  ModelState state;
  state.rover = *campaign_->rover;
  for (const NominalSoil& soil : campaign_->soils) state.soils.push_back(soil.soil);
  for (std::size_t i = 0; i < nuisances_; ++i) {
    const auto& [row, soil] = places_[i];
    if (row->on_rover != nullptr) row->on_rover(x[i], state.rover);
    if (row->name == kTrackLeftOut) state.track_left_out = x[i];
    if (row->on_soil == nullptr) continue;
    for (std::size_t s = 0; s < state.soils.size(); ++s)
      if (soil < 0 || static_cast<std::size_t>(soil) == s) row->on_soil(x[i], state.soils[s]);
  }
  state.effects = all_settings(x);
  for (std::size_t e = 0, at = nuisances_; e < effects_.size(); ++e)
    for (const Free& free : effects_[e].free) {
      double& value = state.effects[e].parameters[free.field];
      const double neutral = parameters_[at++].neutral;
      if (effects_[e].acting != 1.0) value = neutral + effects_[e].acting * (value - neutral);
    }
  for (const sim::EffectSetting& setting : state.effects)
    if (const OutsideCause* const cause = find_outside(setting.name); cause != nullptr && cause->act)
      cause->act({setting.parameters.begin(), setting.parameters.end()}, state);
  std::erase_if(state.effects,
                [](const sim::EffectSetting& s) { return sim::find_effect(s.name) == nullptr; });
  // The rover file's own effects stay at work beside them.
  state.effects = sim::in_force(campaign_->rover->effects, state.effects);
  sim::apply_effects(state.effects, state.rover);
  for (sim::Soil& soil : state.soils) sim::apply_effects(state.effects, soil);
  return state;
}

std::vector<double> Hypothesis::predict(const WindowModel& model, std::span<const double> x,
                                        std::size_t threads) const {
  return as_shown(model, x, model.predict(state(x), threads));
}

std::vector<double> Hypothesis::as_shown(const WindowModel& model, std::span<const double> x,
                                         std::vector<double> predicted) const {
  for (std::size_t p = 0; p < nuisances_; ++p)
    if (parameters_[p].name == kPoseLag && x[p] != 0.0) turn_by_lag(model, x[p], predicted);
  if (const LearntDifference* const learnt = model.learnt()) add_learnt(*learnt, x, predicted);
  const std::vector<sim::EffectSetting> at_x = all_settings(x);
  for (std::size_t e = 0; e < effects_.size(); ++e) {
    if (const OutsideCause* const cause = find_outside(effects_[e].effect); cause != nullptr) {
      if (cause->show) cause->show({at_x[e].parameters.begin(), at_x[e].parameters.end()}, model, predicted);
      continue;
    }
    const sim::Effect& effect = *sim::find_effect(effects_[e].effect);
    if (effect.shown_tilt == nullptr || effects_[e].shown == 0.0) continue;
    const sim::TiltError error = effect.shown_tilt(sim::values_of(effect, at_x[e]));
    std::size_t i = 0;
    for (const DriveWindow& window : model.windows())
      for (const Observation& o : window.observations) {
        if (o.channel == Channel::kRoll) predicted[i] += effects_[e].shown * error.roll_rad;
        if (o.channel == Channel::kPitch) predicted[i] += effects_[e].shown * error.pitch_rad;
        ++i;
      }
  }
  return predicted;
}

void Hypothesis::add_learnt(const LearntDifference& learnt, std::span<const double> x,
                            std::vector<double>& predicted) const {
  Eigen::VectorXd from_centre = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(learnt.centre.size()));
  // Of closures alone soils and motors are where the reference has them.
  for (std::size_t p = 0; p < nuisances_; ++p) {
    const std::size_t at =
        campaign_->reference ? place_in(campaign_->reference->names, parameters_[p].name) : p;
    from_centre[static_cast<Eigen::Index>(at)] = x[p] - learnt.centre[at];
  }
  const Eigen::VectorXd difference = learnt.offset + learnt.slope * from_centre;
  for (std::size_t i = 0; i < predicted.size(); ++i) predicted[i] += difference[static_cast<Eigen::Index>(i)];
}

double Hypothesis::step(std::size_t parameter) const {
  return kDerivativeStep * parameters_[parameter].std;
}

Eigen::MatrixXd Hypothesis::scaled_jacobian(const WindowModel& model, std::span<const double> x,
                                            std::size_t threads, std::span<const double> predicted) const {
  // Of each parameter above and below, where that is not x, whose predictions are given.
  struct Point {
    std::vector<double> x;
    std::optional<std::size_t> near;  // index into `states`
  };
  std::vector<Point> above, below;
  std::vector<WindowModel::NearState> states;
  for (std::size_t p = 0; p < parameters_.size(); ++p) {
    const Parameter& parameter = parameters_[p];
    double high = std::min(parameter.highest, x[p] + step(p));
    double low = std::max(parameter.lowest, x[p] - step(p));
    if (!predicted.empty()) (high - x[p] >= x[p] - low ? low : high) = x[p];
    const bool same_rover = p < nuisances_ && places_[p].row->on_rover == nullptr;
    const auto at = [&](double value) {
      Point point{{x.begin(), x.end()}, {}};
      point.x[p] = value;
      if (value == x[p] && !predicted.empty()) return point;
      point.near = states.size();
      states.push_back({state(point.x), same_rover});
      return point;
    };
    above.push_back(at(high));
    below.push_back(at(low));
  }
  std::vector<std::vector<double>> found = model.predict_near(state(x), states, threads);
  const auto rows = static_cast<Eigen::Index>(model.observation_count());
  Eigen::MatrixXd jacobian(rows, static_cast<Eigen::Index>(parameters_.size()));
  parallel_for(parameters_.size(), threads, [&](std::size_t p) {
    const auto shown = [&](const Point& point) {
      return point.near ? as_shown(model, point.x, std::move(found[*point.near]))
                        : std::vector<double>(predicted.begin(), predicted.end());
    };
    const std::vector<double> high = shown(above[p]), low = shown(below[p]);
    const double scale = parameters_[p].std / (above[p].x[p] - below[p].x[p]);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double slope = scale * (high[static_cast<std::size_t>(i)] - low[static_cast<std::size_t>(i)]);
      jacobian(i, static_cast<Eigen::Index>(p)) = std::isfinite(slope) ? slope : 0.0;
    }
  });
  return jacobian;
}

}  // namespace slipway::gap
