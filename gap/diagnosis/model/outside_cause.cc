#include "gap/diagnosis/model/outside_cause.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/angle.h"
#include "gap/diagnosis/model/window_model.h"

namespace slipway::gap {
namespace {

using Free = sim::EffectVariant::Free;
using Values = OutsideValues;

// Prior deviation of a force, of the rover's weight: what a slope of 1.7 deg does.
constexpr double kForceShare = 0.03;
constexpr double kWheelForceShare = 0.015;
constexpr double kLoadShare = 0.05;
constexpr double kMaxDeviations = 10.0;
const double kSlopeOfForce = std::sin(rad_from_deg(10.0));

Free free_of(std::string field, double std) {
  return {.field = std::move(field),
          .std = std,
          .lowest = -kMaxDeviations * std,
          .highest = kMaxDeviations * std};
}

double weight_n(const DriveCampaign& campaign) {
  return campaign.rover->mass_kg * campaign.gravity_m_s2;
}

sim::EffectVariant way(std::vector<Free> free, std::string label = {},
                       std::vector<std::pair<std::string, double>> fixed = {}) {
  sim::EffectVariant variant;
  variant.label = std::move(label);
  variant.free = std::move(free);
  variant.fixed = std::move(fixed);
  return variant;
}

// Where on the body a force acts: at the ground or well above the deck.
constexpr const char* kHeight = "height_m";

// One way, with these fields free, each of one deviation: a share of the weight; and the height.
template <const auto& Fields>
std::vector<sim::EffectVariant> forces(const DriveCampaign& campaign) {
  std::vector<Free> free;
  for (const char* field : Fields) free.push_back(free_of(field, kForceShare * weight_n(campaign)));
  free.push_back({.field = kHeight, .std = 0.15, .lowest = -0.6, .highest = 0.6});
  return {way(std::move(free))};
}
constexpr std::array kForce{"force_n"};
constexpr std::array kForwardLeft{"forward_n", "left_n"};
constexpr std::array kMapXY{"x_n", "y_n"};

std::vector<sim::EffectVariant> load(const DriveCampaign& campaign) {
  return {way({free_of("force_n", kLoadShare * weight_n(campaign))})};
}

std::vector<sim::EffectVariant> turning(const DriveCampaign& campaign) {
  return {way({free_of("moment_nm", kForceShare * weight_n(campaign) * 0.5 * campaign.rover->track_m())})};
}

// Which wheels are on which axle, from the front.
std::vector<std::vector<std::size_t>> axles_of(const sim::RoverModel& rover) {
  std::map<int, std::vector<std::size_t>, std::greater<>> by_place;
  for (std::size_t k = 0; k < rover.wheels.size(); ++k)
    by_place[static_cast<int>(std::lround(rover.wheels[k].position_m.x() / 0.05))].push_back(k);
  std::vector<std::vector<std::size_t>> axles;
  for (auto& [place, wheels] : by_place) axles.push_back(std::move(wheels));
  return axles;
}

std::string names_of_wheels(const sim::RoverModel& rover, std::span<const std::size_t> wheels) {
  std::string names;
  for (const std::size_t k : wheels) names += (names.empty() ? "" : " and ") + rover.wheels[k].name;
  return names;
}

std::string wheel_field(std::size_t k) {
  return fmt::format("wheel_{}", k);
}

// Each axle as a whole: its wheels are fixed, the force is that of each of them.
std::vector<sim::EffectVariant> axle_forces(const DriveCampaign& campaign) {
  std::vector<sim::EffectVariant> all;
  for (const std::vector<std::size_t>& wheels : axles_of(*campaign.rover)) {
    if (wheels.size() < 2) continue;
    std::vector<std::pair<std::string, double>> fixed;
    for (const std::size_t k : wheels) fixed.emplace_back(wheel_field(k), 1.0);
    all.push_back(way({free_of("force_n", kWheelForceShare * weight_n(campaign))},
                      names_of_wheels(*campaign.rover, wheels), std::move(fixed)));
  }
  return all;
}

std::vector<sim::EffectVariant> wheel_forces(const DriveCampaign& campaign) {
  std::vector<sim::EffectVariant> all;
  for (std::size_t k = 0; k < campaign.rover->wheels.size(); ++k)
    all.push_back(way({free_of("force_n", kForceShare * weight_n(campaign))}, campaign.rover->wheels[k].name,
                      {{wheel_field(k), 1.0}}));
  return all;
}

std::vector<std::size_t> wheels_in(const Values& values) {
  std::vector<std::size_t> wheels;
  for (std::size_t k = 0; k < static_cast<std::size_t>(sim::kMaxWheels); ++k)
    if (values.contains(wheel_field(k))) wheels.push_back(k);
  return wheels;
}

void pull_at_wheels(const Values& values, OutsideForces& forces) {
  for (const std::size_t k : wheels_in(values)) forces.along_at_wheel_n[k] += values.at("force_n");
}

// A gain of one wheel's current alone; one of all is the motors' torque constant.
std::vector<sim::EffectVariant> current_gains(const DriveCampaign& campaign) {
  std::vector<sim::EffectVariant> all;
  for (std::size_t k = 0; k < campaign.rover->wheels.size(); ++k)
    all.push_back(way({free_of("gain", 0.05)}, campaign.rover->wheels[k].name, {{wheel_field(k), 1.0}}));
  return all;
}

template <const auto& Fields, int Percent>
std::vector<sim::EffectVariant> gains(const DriveCampaign& /*campaign*/) {
  std::vector<Free> free;
  for (const char* field : Fields) free.push_back(free_of(field, 0.01 * Percent));
  return {way(std::move(free))};
}
constexpr std::array kGain{"gain"};

std::vector<sim::EffectVariant> sinkage_sensor(const DriveCampaign& /*campaign*/) {
  return {way({free_of("gain", 0.1), free_of("offset_m", 0.002)})};
}

std::vector<sim::EffectVariant> heading_offset(const DriveCampaign& /*campaign*/) {
  return {way({free_of("offset_rad", 0.02)})};
}

// Every observation of a window with its prediction, which `change` turns into what is shown.
template <class Change>
void for_each_reading(const WindowModel& model, std::vector<double>& predicted, const Change& change) {
  for (std::size_t w = 0; w < model.windows().size(); ++w)
    for (std::size_t i = 0; i < model.windows()[w].observations.size(); ++i) {
      double& value = predicted[model.offset(w) + i];
      if (std::isfinite(value)) change(w, model.windows()[w].observations[i], value);
    }
}

void show_current_gain(const Values& values, const WindowModel& model, std::vector<double>& predicted) {
  const std::vector<std::size_t> wheels = wheels_in(values);
  for_each_reading(model, predicted, [&](std::size_t, const Observation& o, double& value) {
    if (o.channel == Channel::kCurrent && o.wheel >= 0 &&
        std::find(wheels.begin(), wheels.end(), static_cast<std::size_t>(o.wheel)) != wheels.end())
      value *= 1.0 + values.at("gain");
  });
}

void show_current_drift(const Values& values, const WindowModel& model, std::vector<double>& predicted) {
  const double last = std::max(1.0, static_cast<double>(model.campaign().drives.size()) - 1.0);
  for_each_reading(model, predicted, [&](std::size_t w, const Observation& o, double& value) {
    if (o.channel == Channel::kCurrent)
      value *= 1.0 + values.at("gain") * static_cast<double>(model.windows()[w].drive) / last;
  });
}

void show_distance_gain(const Values& values, const WindowModel& model, std::vector<double>& predicted) {
  for_each_reading(model, predicted, [&](std::size_t w, const Observation& o, double& value) {
    if (o.channel == Channel::kSlip && !model.windows()[w].command.turn_in_place)
      value -= values.at("gain") * (1.0 - value);
  });
}

void show_sinkage(const Values& values, const WindowModel& model, std::vector<double>& predicted) {
  for_each_reading(model, predicted, [&](std::size_t, const Observation& o, double& value) {
    if (o.channel == Channel::kSinkage) value = (1.0 + values.at("gain")) * value + values.at("offset_m");
  });
}

double middle_yaw(const DriveWindow& window) {
  return window.stations[window.stations.size() / 2].yaw_rad;
}

// How far the recorded heading has turned since each window's drive began.
std::vector<double> turned_since_start(const WindowModel& model) {
  std::vector<double> turned(model.windows().size(), 0.0);
  for (std::size_t w = 1; w < turned.size(); ++w) {
    const DriveWindow &before = model.windows()[w - 1], &now = model.windows()[w];
    if (before.drive != now.drive) continue;
    turned[w] = turned[w - 1] + std::remainder(middle_yaw(now) - middle_yaw(before), 2.0 * std::numbers::pi);
  }
  return turned;
}

// Motion seen along a heading that is `off_rad` too far to the left.
void turn_side_slip(const DriveWindow& window, double off_rad, double& side_slip) {
  side_slip -= std::copysign(off_rad, window.command.speed_m_s);
}

void show_heading_gain(const Values& values, const WindowModel& model, std::vector<double>& predicted) {
  const double gain = values.at("gain");
  const std::vector<double> turned = turned_since_start(model);
  for_each_reading(model, predicted, [&](std::size_t w, const Observation& o, double& value) {
    const DriveWindow& window = model.windows()[w];
    const sim::DriveCommand& command = window.command;
    if (command.turn_in_place) {
      if (o.channel == Channel::kSlip) value -= gain * (1.0 - value);
      return;
    }
    if (o.channel == Channel::kYawRate) value += gain * (value + command.speed_m_s * command.curvature_1_m);
    if (o.channel == Channel::kSideSlip) turn_side_slip(window, gain / (1.0 + gain) * turned[w], value);
  });
}

void show_heading_offset(const Values& values, const WindowModel& model, std::vector<double>& predicted) {
  for_each_reading(model, predicted, [&](std::size_t w, const Observation& o, double& value) {
    if (o.channel == Channel::kSideSlip) turn_side_slip(model.windows()[w], values.at("offset_rad"), value);
  });
}

std::string along_words(double force_n) {
  return force_n < 0.0 ? "against the travel" : "with the travel";
}

std::string percent(double share) {
  return fmt::format("{:.1f} % {}", 100.0 * std::abs(share), share < 0.0 ? "less" : "more");
}

std::string pull_words(const Values& v, const DriveCampaign& /*campaign*/) {
  return fmt::format("a steady pull of {:.3g} N {}, at the body", std::abs(v.at("force_n")),
                     along_words(v.at("force_n")));
}

std::string push_words(const Values& v, const DriveCampaign& /*campaign*/) {
  const double x = v.at("x_n"), y = v.at("y_n");
  return fmt::format("a steady push of {:.3g} N towards {:.0f} deg on the map (0 is its x axis), at the body",
                     std::hypot(x, y), deg_from_rad(std::atan2(y, x)));
}

std::string body_words(const Values& v, const DriveCampaign& /*campaign*/) {
  const double x = v.at("forward_n"), y = v.at("left_n");
  return fmt::format("a steady push of {:.3g} N in the body's own frame, {:.0f} deg to the left of its front",
                     std::hypot(x, y), deg_from_rad(std::atan2(y, x)));
}

std::string speed_words(const Values& v, const DriveCampaign& /*campaign*/) {
  return fmt::format("a pull that grows with speed, {:.3g} N {} at cruise speed, at the body",
                     std::abs(v.at("force_n")), along_words(v.at("force_n")));
}

std::string slope_words(const Values& v, const DriveCampaign& /*campaign*/) {
  return fmt::format("a pull that grows with the slope, {:.3g} N {} at 10 deg, at the body",
                     std::abs(v.at("force_n")), v.at("force_n") < 0.0 ? "downhill" : "uphill");
}

std::string load_words(const Values& v, const DriveCampaign& campaign) {
  return fmt::format("{:.3g} N {} on the wheels than the rover's weight ({:.1f} %), at the body",
                     std::abs(v.at("force_n")), v.at("force_n") < 0.0 ? "less" : "more",
                     100.0 * std::abs(v.at("force_n")) / weight_n(campaign));
}

std::string turning_words(const Values& v, const DriveCampaign& /*campaign*/) {
  return fmt::format("a steady moment of {:.3g} N m to the {}, on the body", std::abs(v.at("moment_nm")),
                     v.at("moment_nm") < 0.0 ? "right" : "left");
}

std::string wheel_words(const Values& v, const DriveCampaign& campaign) {
  const std::vector<std::size_t> wheels = wheels_in(v);
  return fmt::format("a steady pull of {:.3g} N {}, at {} {}", std::abs(v.at("force_n")),
                     along_words(v.at("force_n")), wheels.size() > 1 ? "each of the axles of" : "the axle of",
                     names_of_wheels(*campaign.rover, wheels));
}

std::string current_words(const Values& v, const DriveCampaign& campaign) {
  return fmt::format("the current of {} reads {}", names_of_wheels(*campaign.rover, wheels_in(v)),
                     percent(v.at("gain")));
}

std::string drift_words(const Values& v, const DriveCampaign& /*campaign*/) {
  return fmt::format("currents drift: the last drive's read {} than the first's", percent(v.at("gain")));
}

std::string distance_words(const Values& v, const DriveCampaign& /*campaign*/) {
  return fmt::format("distances read {}", percent(v.at("gain")));
}

std::string heading_words(const Values& v, const DriveCampaign& /*campaign*/) {
  return fmt::format("changes of heading read {}", percent(v.at("gain")));
}

std::string offset_words(const Values& v, const DriveCampaign& /*campaign*/) {
  return fmt::format("headings read {:.2f} deg too far to the {}", std::abs(deg_from_rad(v.at("offset_rad"))),
                     v.at("offset_rad") < 0.0 ? "right" : "left");
}

std::string sinkage_words(const Values& v, const DriveCampaign& /*campaign*/) {
  return fmt::format("sinkages read {} and {:+.1f} mm", percent(v.at("gain")), 1e3 * v.at("offset_m"));
}

constexpr std::array kRows{
    OutsideCause{.name = "pull_along_travel",
                 .form = "force_on_body",
                 .entry = "tangential_force",
                 .depends = "direction",
                 .unit = "N",
                 .variants = &forces<kForce>,
                 .act =
                     [](const Values& v, OutsideForces& f) {
                       f.along_n += v.at("force_n");
                       f.height_m = v.at(kHeight);
                     },
                 .words = &pull_words},
    OutsideCause{.name = "push_on_map",
                 .form = "force_on_body",
                 .entry = "tangential_force",
                 .depends = "heading",
                 .unit = "N",
                 .variants = &forces<kMapXY>,
                 .act =
                     [](const Values& v, OutsideForces& f) {
                       f.on_map_n += Eigen::Vector2d(v.at("x_n"), v.at("y_n"));
                       f.height_m = v.at(kHeight);
                     },
                 .words = &push_words},
    OutsideCause{.name = "push_in_body",
                 .form = "force_on_body",
                 .entry = "lateral_force",
                 .depends = "constant",
                 .unit = "N",
                 .variants = &forces<kForwardLeft>,
                 .act =
                     [](const Values& v, OutsideForces& f) {
                       f.in_body_n += Eigen::Vector2d(v.at("forward_n"), v.at("left_n"));
                       f.height_m = v.at(kHeight);
                     },
                 .words = &body_words,
                 .twin_of_an_effect = true},
    OutsideCause{.name = "pull_with_speed",
                 .form = "force_on_body",
                 .entry = "tangential_force",
                 .depends = "speed",
                 .unit = "N",
                 .variants = &forces<kForce>,
                 .act =
                     [](const Values& v, OutsideForces& f) {
                       f.along_by_speed_n += v.at("force_n");
                       f.height_m = v.at(kHeight);
                     },
                 .words = &speed_words},
    OutsideCause{.name = "pull_with_slope",
                 .form = "force_on_body",
                 .entry = "tangential_force",
                 .depends = "pitch",
                 .unit = "N",
                 .variants = &forces<kForce>,
                 .act =
                     [](const Values& v, OutsideForces& f) {
                       f.along_by_slope_n += v.at("force_n");
                       f.height_m = v.at(kHeight);
                     },
                 .words = &slope_words},
    OutsideCause{.name = "load",
                 .form = "force_on_body",
                 .entry = "wheel_load",
                 .depends = "constant",
                 .unit = "N",
                 .variants = &load,
                 .act = [](const Values& v, OutsideForces& f) { f.load_n += v.at("force_n"); },
                 .words = &load_words},
    OutsideCause{.name = "turning_moment",
                 .form = "moment_on_body",
                 .entry = "yaw",
                 .depends = "constant",
                 .unit = "N m",
                 .variants = &turning,
                 .act = [](const Values& v, OutsideForces& f) { f.turning_nm += v.at("moment_nm"); },
                 .words = &turning_words},
    OutsideCause{.name = "pull_at_axle",
                 .form = "force_at_axle",
                 .entry = "tangential_force",
                 .depends = "direction",
                 .unit = "N",
                 .variants = &axle_forces,
                 .act = &pull_at_wheels,
                 .words = &wheel_words},
    OutsideCause{.name = "pull_at_wheel",
                 .form = "force_at_wheel",
                 .entry = "tangential_force",
                 .depends = "direction",
                 .unit = "N",
                 .variants = &wheel_forces,
                 .act = &pull_at_wheels,
                 .words = &wheel_words},
    OutsideCause{.name = "current_gain",
                 .form = "sensor",
                 .entry = "torque_to_current",
                 .depends = "constant",
                 .unit = "1",
                 .variants = &current_gains,
                 .show = &show_current_gain,
                 .words = &current_words},
    OutsideCause{.name = "current_drift",
                 .form = "sensor",
                 .entry = "torque_to_current",
                 .depends = "order",
                 .unit = "1",
                 .variants = &gains<kGain, 5>,
                 .show = &show_current_drift,
                 .words = &drift_words},
    OutsideCause{.name = "distance_gain",
                 .form = "sensor",
                 .entry = "slip_sensor",
                 .depends = "constant",
                 .unit = "1",
                 .variants = &gains<kGain, 3>,
                 .show = &show_distance_gain,
                 .words = &distance_words},
    OutsideCause{.name = "heading_gain",
                 .form = "sensor",
                 .entry = "yaw",
                 .depends = "turning",
                 .unit = "1",
                 .variants = &gains<kGain, 3>,
                 .show = &show_heading_gain,
                 .words = &heading_words},
    OutsideCause{.name = "heading_offset",
                 .form = "sensor",
                 .entry = "side_slip",
                 .depends = "direction",
                 .unit = "rad",
                 .variants = &heading_offset,
                 .show = &show_heading_offset,
                 .words = &offset_words},
    OutsideCause{.name = "sinkage_sensor",
                 .form = "sensor",
                 .entry = "sinkage",
                 .depends = "constant",
                 .unit = "1",
                 .variants = &sinkage_sensor,
                 .show = &show_sinkage,
                 .words = &sinkage_words},
};

}  // namespace

bool OutsideForces::any() const {
  return along_n != 0.0 || along_by_speed_n != 0.0 || along_by_slope_n != 0.0 || !in_body_n.isZero(0.0) ||
         !on_map_n.isZero(0.0) || load_n != 0.0 || turning_nm != 0.0 || !along_at_wheel_n.empty();
}

sim::OutsideWrench wrench_of(const OutsideForces& forces, const sim::RoverModel& rover,
                             const sim::Stance& stance, const sim::DriveCommand& command) {
  const double sense = command.turn_in_place ? 0.0 : command.speed_m_s < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector2d direction = sim::travel_direction(command);
  const Eigen::Vector3d travel(sense * direction.x(), sense * direction.y(), 0.0);
  const double speed =
      rover.cruise_speed_m_s > 0.0 ? std::abs(command.speed_m_s) / rover.cruise_speed_m_s : 1.0;
  const double climb = stance.R_MB(2, 0) / kSlopeOfForce;  // of the body's front, 1 at 10 deg
  sim::OutsideWrench wrench;
  wrench.force_n =
      (forces.along_n + forces.along_by_speed_n * speed) * travel +
      Eigen::Vector3d(forces.in_body_n.x() + forces.along_by_slope_n * climb, forces.in_body_n.y(), 0.0) +
      stance.R_MB.transpose() * Eigen::Vector3d(forces.on_map_n.x(), forces.on_map_n.y(), -forces.load_n);
  const Eigen::Vector3d at = rover.com_m + forces.height_m * Eigen::Vector3d::UnitZ();
  wrench.moment_nm = at.cross(wrench.force_n) + forces.turning_nm * Eigen::Vector3d::UnitZ();
  if (forces.along_at_wheel_n.empty()) return wrench;
  wrench.at_wheel_n = sim::PerWheel<Eigen::Vector3d>(rover.wheels.size(), Eigen::Vector3d::Zero());
  for (const auto& [wheel, force_n] : forces.along_at_wheel_n) wrench.at_wheel_n[wheel] = force_n * travel;
  return wrench;
}

std::span<const OutsideCause> outside_catalogue() {
  return kRows;
}

const OutsideCause* find_outside(std::string_view name) {
  const auto row =
      std::find_if(kRows.begin(), kRows.end(), [name](const OutsideCause& c) { return c.name == name; });
  return row == kRows.end() ? nullptr : &*row;
}

std::vector<sim::EffectVariant> outside_variants(const DriveCampaign& campaign) {
  std::vector<sim::EffectVariant> all;
  for (const OutsideCause& cause : kRows)
    for (sim::EffectVariant& variant : cause.variants(campaign)) {
      variant.effect = cause.name;
      all.push_back(std::move(variant));
    }
  return all;
}

}  // namespace slipway::gap
