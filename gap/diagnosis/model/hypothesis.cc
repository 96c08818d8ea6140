#include "gap/diagnosis/model/hypothesis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/angle.h"
#include "core/parallel_for.h"

namespace slipway::gap {
namespace {

using Free = EffectVariant::Free;

// Of a parameter's std.
constexpr double kStep = 0.05;
// Share of its usual deviation that a nuisance is believed with where it is held at nominal.
constexpr double kHeld = 1e-3;

// Where the catalogue's fields alone do not say what to estimate.
struct Row {
  std::string_view effect;
  std::vector<EffectVariant> (*variants)(const sim::RoverModel& rover);
};

EffectVariant variant(std::string effect, std::string label, std::vector<Free> free,
                      std::vector<std::pair<std::string, double>> fixed = {}) {
  EffectVariant v;
  v.effect = std::move(effect);
  v.label = std::move(label);
  v.free = std::move(free);
  v.fixed = std::move(fixed);
  return v;
}

std::vector<EffectVariant> dragging(const sim::RoverModel& rover) {
  std::vector<EffectVariant> all;
  for (std::size_t k = 0; k < rover.wheels.size(); ++k) {
    const auto number = static_cast<double>(k);
    all.push_back(variant("dragging_wheel", rover.wheels[k].name,
                          {{"rate_share", 0.4, 0.02, 1.0}, {"drag_nm", 3.0, 0.0, 50.0}},
                          {{"wheel", number}}));
  }
  return all;
}

std::vector<EffectVariant> steering(const sim::RoverModel& rover) {
  const Free angle{"angle_deg", 2.0, -20.0, 20.0};
  std::vector<EffectVariant> all{variant("steering_offset", "all that steer", {angle}, {{"wheel", -1.0}})};
  for (std::size_t k = 0; k < rover.wheels.size(); ++k)
    if (rover.wheels[k].steerable)
      all.push_back(
          variant("steering_offset", rover.wheels[k].name, {angle}, {{"wheel", static_cast<double>(k)}}));
  return all;
}

std::vector<EffectVariant> attitude(const sim::RoverModel& /*rover*/) {
  const std::vector<Free> free{{"roll_deg", 1.0, -10.0, 10.0}, {"pitch_deg", 1.0, -10.0, 10.0}};
  EffectVariant sensor = variant("attitude_bias", "the inclinometer alone", free);
  sensor.shown = 1.0;
  sensor.acting = 0.0;
  EffectVariant map = variant("attitude_bias", "the map alone", free);
  map.shown = 1.0;
  return {sensor, map, variant("attitude_bias", "map and inclinometer", free)};
}

std::vector<EffectVariant> crust(const sim::RoverModel& /*rover*/) {
  std::vector<EffectVariant> all;
  for (const double depth_m : {0.003, 0.006, 0.012, 0.025})
    all.push_back(variant("duricrust", fmt::format("breaking at {:g} mm", 1e3 * depth_m),
                          {{"strength_pa", 5000.0, 0.0, 100000.0}}, {{"depth_m", depth_m}}));
  return all;
}

std::vector<EffectVariant> hard_layer(const sim::RoverModel& /*rover*/) {
  std::vector<EffectVariant> all;
  for (const double depth_m : {0.005, 0.01, 0.015, 0.02, 0.03})
    all.push_back(variant("hardpan", fmt::format("at {:g} mm", 1e3 * depth_m),
                          {{"modulus_pa_m", 2e6, 0.0, 1e8}}, {{"depth_m", depth_m}}));
  return all;
}

std::vector<EffectVariant> cleats(const sim::RoverModel& /*rover*/) {
  const std::vector<Free> free{{"height_m", 0.01, 0.0, 0.05}, {"mobilisation", 0.5, 0.02, 1.0}};
  return {variant("grousers", "mobilised along the rim", free, {{"by_slip", 0.0}}),
          variant("grousers", "mobilised by slip", free, {{"by_slip", 1.0}})};
}

std::vector<EffectVariant> gearbox(const sim::RoverModel& /*rover*/) {
  return {
      variant("gearbox_friction", "", {{"torque_nm", 0.5, 0.0, 50.0}, {"efficiency_loss", 0.1, 0.0, 0.9}})};
}

std::vector<EffectVariant> temperature(const sim::RoverModel& /*rover*/) {
  return {variant("motor_temperature", "",
                  {{"kt_per_k", 0.0011, 0.0, 0.005}, {"friction_per_k", 0.015, 0.0, 0.05}})};
}

std::vector<EffectVariant> sinkage(const sim::RoverModel& /*rover*/) {
  return {variant("slip_sinkage", "", {{"n1", 0.3, 0.0, 1.5}})};
}

std::vector<EffectVariant> speed_shear(const sim::RoverModel& /*rover*/) {
  return {variant("rate_shear", "", {{"exponent", 0.3, -1.0, 1.0}})};
}

std::vector<EffectVariant> tracks(const sim::RoverModel& /*rover*/) {
  return {variant("multipass", "", {{"stiffening", 0.4, 0.0, 5.0}})};
}

std::vector<EffectVariant> heap(const sim::RoverModel& /*rover*/) {
  const Free share{"share", 1.0, 0.0, 5.0};
  return {variant("bulldozing", "before wheels on fresh ground", {share}, {{"in_tracks", 0.0}}),
          variant("bulldozing", "before every wheel", {share}, {{"in_tracks", 1.0}})};
}

// Height is re-tuned anyhow: by it other laws of pulls and ruts show.
std::vector<EffectVariant> centre_of_mass(const sim::RoverModel& /*rover*/) {
  return {variant("com_offset", "", {{"x_m", 0.05, -0.5, 0.5}, {"y_m", 0.05, -0.5, 0.5}})};
}

std::vector<EffectVariant> none(const sim::RoverModel& /*rover*/) {
  return {};
}

constexpr std::array kRows{Row{"dragging_wheel", &dragging},  Row{"steering_offset", &steering},
                           Row{"attitude_bias", &attitude},   Row{"duricrust", &crust},
                           Row{"hardpan", &hard_layer},       Row{"grousers", &cleats},
                           Row{"gearbox_friction", &gearbox}, Row{"motor_temperature", &temperature},
                           Row{"slip_sinkage", &sinkage},     Row{"rate_shear", &speed_shear},
                           Row{"multipass", &tracks},         Row{"com_offset", &centre_of_mass},
                           Row{"soft_patch", &none},          Row{"bulldozing", &heap},
                           Row{"soil_gravity", &none},        Row{"smooth_rim", &none}};

// Effects of soils and motors that other authors write with other equations. The rest are geometry.
constexpr std::array<std::string_view, 10> kOfManyForms{
    "soft_patch",      "slip_sinkage", "multipass",        "grousers", "bulldozing",
    "side_bulldozing", "duricrust",    "gearbox_friction", "hardpan",  "motor_temperature"};

// All fields with a neutral value, believed to be about as far from it as the catalogue's initial value.
EffectVariant from_catalogue(const sim::Effect& effect) {
  EffectVariant v;
  v.effect = effect.name;
  for (const Field& field : effect.fields) {
    if (!field.neutral) continue;
    double std = std::abs(field.initial - *field.neutral);
    for (const Field& other : effect.fields)
      if (std == 0.0 && other.neutral && other.unit == field.unit)
        std = std::abs(other.initial - *other.neutral);
    v.free.push_back({std::string(field.name), std > 0.0 ? std : 0.1 * (field.highest - field.lowest),
                      field.lowest, field.highest});
  }
  return v;
}

// Motion along a heading that is recorded `lag_s` later.
void turn_by_lag(const WindowModel& model, double lag_s, std::vector<double>& predicted) {
  for (std::size_t w = 0; w < model.windows().size(); ++w) {
    const DriveWindow& window = model.windows()[w];
    const sim::DriveCommand& command = window.command;
    if (command.turn_in_place) continue;
    double along = 1.0, yaw_rate = command.speed_m_s * command.curvature_1_m;
    std::optional<std::size_t> side;
    for (std::size_t i = 0; i < window.observations.size(); ++i) {
      const std::size_t row = model.offset(w) + i;
      if (!std::isfinite(predicted[row])) continue;
      if (window.observations[i].channel == Channel::kSlip) along = 1.0 - predicted[row];
      if (window.observations[i].channel == Channel::kYawRate) yaw_rate += predicted[row];
      if (window.observations[i].channel == Channel::kSideSlip) side = row;
    }
    if (side) predicted[*side] -= std::copysign(along, command.speed_m_s) * yaw_rate * lag_s;
  }
}

double neutral_of(const std::string& effect, const std::string& field) {
  for (const Field& f : sim::find_effect(effect)->fields)
    if (f.name == field) return f.neutral.value_or(f.initial);
  return 0.0;
}

}  // namespace

bool has_many_forms(std::string_view effect) {
  return std::find(kOfManyForms.begin(), kOfManyForms.end(), effect) != kOfManyForms.end();
}

std::vector<EffectVariant> effect_variants(const sim::RoverModel& rover,
                                           std::span<const std::string> withheld) {
  std::vector<EffectVariant> all;
  for (const sim::Effect& effect : sim::effect_catalogue()) {
    if (std::find(withheld.begin(), withheld.end(), effect.name) != withheld.end()) continue;
    const auto row =
        std::find_if(kRows.begin(), kRows.end(), [&](const Row& r) { return r.effect == effect.name; });
    if (row == kRows.end()) {
      all.push_back(from_catalogue(effect));
    } else {
      for (EffectVariant& v : row->variants(rover)) all.push_back(std::move(v));
    }
  }
  return all;
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
      const double std = wide ? kTotalTorqueStd : row.std;
      const double farthest = wide ? 3.0 * kTotalTorqueStd : 0.0;
      parameters_.push_back({name, "", 0.0, held ? kHeld * std : std, std::min(row.lowest, -farthest),
                             std::max(row.highest, farthest), quantity_of(row),
                             row.kind == NuisanceKind::kSoil ? soil : -1});
      places_.push_back({&row, row.kind == NuisanceKind::kSoil ? soil : -1});
    }
  }
  nuisances_ = parameters_.size();
  for (const EffectVariant& v : effects_)
    for (const Free& free : v.free)
      parameters_.push_back({v.effect + "." + free.field, v.effect, neutral_of(v.effect, free.field),
                             free.std, free.lowest, free.highest});
}

std::vector<double> Hypothesis::neutral() const {
  std::vector<double> x;
  for (const Parameter& p : parameters_) x.push_back(p.neutral);
  return x;
}

std::vector<sim::EffectSetting> Hypothesis::settings(std::span<const double> x) const {
  std::vector<sim::EffectSetting> settings;
  std::size_t at = nuisances_;
  for (const EffectVariant& v : effects_) {
    sim::EffectSetting setting{.name = v.effect, .parameters = {}};
    for (const auto& [field, value] : v.fixed) setting.parameters[field] = value;
    for (const Free& free : v.free) setting.parameters[free.field] = x[at++];
    // Fields that are neither take their neutral value, so that nothing else is at work.
    for (const Field& f : sim::find_effect(v.effect)->fields)
      if (f.neutral && f.name != "count") setting.parameters.try_emplace(std::string(f.name), *f.neutral);
    settings.push_back(std::move(setting));
  }
  return settings;
}

ModelState Hypothesis::state(std::span<const double> x) const {
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
  for (sim::EffectSetting& setting : settings(x)) {
    const auto variant = std::find_if(effects_.begin(), effects_.end(),
                                      [&](const EffectVariant& v) { return v.effect == setting.name; });
    if (setting.name == "attitude_bias")
      for (auto& [field, value] : setting.parameters) value *= variant->acting;
    state.effects.push_back(setting);
  }
  // The rover file's own effects stay at work beside them.
  state.effects = sim::in_force(campaign_->rover->effects, state.effects);
  sim::apply_effects(state.effects, state.rover);
  for (sim::Soil& soil : state.soils) {
    const double n1 = soil.n1;
    sim::apply_effects(state.effects, soil);
    if (n1 != 0.0 && soil.n1 == 0.0) soil.n1 = n1;
  }
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
  for (const EffectVariant& v : effects_) {
    if (v.shown == 0.0) continue;
    double roll = 0.0, pitch = 0.0;
    for (std::size_t i = nuisances_; i < parameters_.size(); ++i) {
      if (parameters_[i].name == "attitude_bias.roll_deg") roll = rad_from_deg(x[i]);
      if (parameters_[i].name == "attitude_bias.pitch_deg") pitch = rad_from_deg(x[i]);
    }
    std::size_t i = 0;
    for (const DriveWindow& window : model.windows())
      for (const Observation& o : window.observations) {
        if (o.channel == Channel::kRoll) predicted[i] += v.shown * roll;
        if (o.channel == Channel::kPitch) predicted[i] += v.shown * pitch;
        ++i;
      }
  }
  return predicted;
}

double Hypothesis::step(std::size_t parameter) const {
  return kStep * parameters_[parameter].std;
}

Eigen::MatrixXd Hypothesis::scaled_jacobian(const WindowModel& model, std::span<const double> x,
                                            std::size_t threads, std::span<const double> predicted) const {
  const auto rows = static_cast<Eigen::Index>(model.observation_count());
  Eigen::MatrixXd jacobian(rows, static_cast<Eigen::Index>(parameters_.size()));
  const WindowModel::Starts starts = model.starts_at(state(x), threads);
  parallel_for(parameters_.size(), threads, [&](std::size_t p) {
    const Parameter& parameter = parameters_[p];
    std::vector<double> low(x.begin(), x.end()), high = low;
    high[p] = std::min(parameter.highest, x[p] + step(p));
    low[p] = std::max(parameter.lowest, x[p] - step(p));
    if (!predicted.empty()) (high[p] - x[p] >= x[p] - low[p] ? low[p] : high[p]) = x[p];
    const auto at = [&](const std::vector<double>& there) {
      return there[p] == x[p] && !predicted.empty()
                 ? std::vector<double>(predicted.begin(), predicted.end())
                 : as_shown(model, there, model.predict_near(starts, state(there)));
    };
    const std::vector<double> above = at(high), below = at(low);
    const double scale = parameter.std / (high[p] - low[p]);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double slope = scale * (above[static_cast<std::size_t>(i)] - below[static_cast<std::size_t>(i)]);
      jacobian(i, static_cast<Eigen::Index>(p)) = std::isfinite(slope) ? slope : 0.0;
    }
  });
  return jacobian;
}

}  // namespace slipway::gap
