#include "campaign/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "sim/effects/effect_catalogue.h"
#include "sim/single_wheel/sweep_parameter.h"

namespace slipway::campaign {
namespace {

constexpr std::string_view kSoil = "soil.", kEffects = "effects.";
constexpr Field kShearModulus{"soil.shear_modulus_m", "m", "Janosi-Hanamoto's K, both ways", 1e-4, 1.0, 0.01};

struct EffectField {
  std::string effect, field;
};

std::optional<EffectField> effect_field(std::string_view name) {
  if (!name.starts_with(kEffects)) return std::nullopt;
  name.remove_prefix(kEffects.size());
  const std::size_t dot = name.find('.');
  if (dot == std::string_view::npos) return std::nullopt;
  return EffectField{std::string(name.substr(0, dot)), std::string(name.substr(dot + 1))};
}

void set_in_soil(std::string_view name, double value, sim::Soil& soil) {
  if (name == kShearModulus.name) {
    soil.shear_modulus_x_m = soil.shear_modulus_y_m = value;
    return;
  }
  sim::WheelRig rig;
  rig.soil = soil;
  sim::set_sweep_parameter(name, value, rig);
  soil = rig.soil;
}

// The rover's own setting of the effect is the base, unless the table has one.
void set_in_effects(const EffectField& place, double value, DriveTable& table) {
  const auto named = [&](const sim::EffectSetting& s) { return s.name == place.effect; };
  auto setting = std::find_if(table.effects.begin(), table.effects.end(), named);
  if (setting == table.effects.end()) {
    const auto& rovers = table.rover->effects;
    const auto own = std::find_if(rovers.begin(), rovers.end(), named);
    table.effects.push_back(own == rovers.end() ? sim::EffectSetting{.name = place.effect, .parameters = {}}
                                                : *own);
    setting = table.effects.end() - 1;
  }
  setting->on = true;
  setting->parameters[place.field] = value;
}

std::vector<Fault> faults_of(const TuneRequest& request) {
  std::vector<Fault> faults;
  for (std::size_t k = 0; k < request.parameters.size(); ++k) {
    const gap::SweptParameter& p = request.parameters[k].sweep;
    const std::string pointer = fmt::format("/parameters/{}", k);
    const std::optional<Field> field = tuning_field(p.name);
    if (!field) {
      faults.push_back({pointer + "/name", fmt::format("\"{}\" can't be tuned; what can: {}", p.name,
                                                       fmt::join(tuning_field_names(), ", "))});
      continue;
    }
    for (const auto& [end, value] : {std::pair("lowest", p.lowest), std::pair("highest", p.highest)})
      if (!(value >= field->lowest && value <= field->highest))
        faults.push_back(
            {fmt::format("{}/{}", pointer, end), fmt::format("{} = {} {}, must be in [{}, {}]", p.name, value,
                                                             field->unit, field->lowest, field->highest)});
  }
  return faults;
}

double tilt_at_start(const DriveTable& table, const TableDrive& drive) {
  const auto surface = table.terrains[drive.terrain].ground->surface(drive.start.x_m, drive.start.y_m);
  return surface ? std::acos(std::clamp(surface->normal.z(), -1.0, 1.0)) : 0.0;
}

// One drive's steps are no news.
class Quiet final : public Progress {
 public:
  explicit Quiet(const Progress& whole) : whole_(whole) {}
  void report(std::string_view /*stage*/, double /*fraction*/) override {}
  bool cancelled() const override { return whole_.cancelled(); }

 private:
  const Progress& whole_;
};

}  // namespace

std::optional<Field> tuning_field(std::string_view name) {
  if (name == kShearModulus.name) return kShearModulus;
  if (name.starts_with(kSoil)) return sim::sweep_field(name);
  const auto place = effect_field(name);
  const sim::Effect* effect = place ? sim::find_effect(place->effect) : nullptr;
  if (effect == nullptr || effect->region != nullptr) return std::nullopt;
  for (const Field& field : effect->fields)
    if (field.name == place->field) return field;
  return std::nullopt;
}

std::vector<std::string> tuning_field_names() {
  std::vector<std::string> names{std::string(kShearModulus.name)};
  for (const std::string& name : sim::sweep_field_names())
    if (name.starts_with(kSoil)) names.push_back(name);
  for (const sim::Effect& effect : sim::effect_catalogue()) {
    if (effect.region != nullptr) continue;
    for (const Field& field : effect.fields)
      names.push_back(fmt::format("{}{}.{}", kEffects, effect.name, field.name));
  }
  return names;
}

void set_tuned(std::string_view name, double value, DriveTable& table) {
  if (const auto place = effect_field(name)) return set_in_effects(*place, value, table);
  for (auto& [soil_name, soil] : table.soils) set_in_soil(name, value, soil.mean);
}

Result<TableTuning> tune(const DriveTable& table, std::span<const TableDrive> drives,
                         const MeasuredFinals& measured, const TuneRequest& request, Progress& progress) {
  if (auto faults = faults_of(request); !faults.empty())
    return fail(ErrorCode::kInvalidRequest, "the parameters can't be tuned", std::move(faults));
  TableTuning result;
  std::map<std::string, std::size_t> place_of;  // by the id of the first of its repeats
  std::vector<const TableDrive*> simulated;
  std::set<std::string> soils;
  for (const TableDrive& drive : drives) {
    const auto end = measured.find(drive.id);
    if (end == measured.end()) {
      result.unmeasured.push_back(drive.id);
      continue;
    }
    const std::string& name = drive.repeat_of.empty() ? drive.id : drive.repeat_of;
    const auto [place, is_new] = place_of.try_emplace(name, result.drives.size());
    if (is_new) {
      result.drives.push_back({.name = name, .tilt_rad = tilt_at_start(table, drive), .finals = {}});
      simulated.push_back(&drive);
      for (std::string& soil : soils_of(table.terrains[drive.terrain])) soils.insert(std::move(soil));
    }
    result.drives[place->second].finals.push_back(end->second);
  }
  if (result.drives.empty()) return fail(ErrorCode::kNoData, "none of the drives has a measured end");
  if (soils.size() > 1)
    return fail(ErrorCode::kInvalidRequest,
                fmt::format("the drives are on different soils ({}): tune to those of one at a time",
                            fmt::join(soils, ", ")));
  result.soil = *soils.begin();
  const gap::FinalPose model = [&](std::size_t drive, std::span<const double> x) -> std::optional<Pose2> {
    DriveTable tried = table;
    tried.draw_soils = false;
    for (std::size_t k = 0; k < x.size(); ++k) set_tuned(request.parameters[k].sweep.name, x[k], tried);
    Quiet quiet(progress);
    const MadeDrive made = make_drive(tried, *simulated[drive], request.simulator, quiet);
    if (!made.drive) return std::nullopt;
    return made.drive->final;
  };
  auto tuning = gap::tune_drives(request.parameters, result.drives, model, request.options, progress);
  if (!tuning) return fail(tuning.error());
  result.tuning = std::move(*tuning);
  return result;
}

}  // namespace slipway::campaign
