#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/angle.h"
#include "gap/diagnosis/model/outside_cause_rows.h"
#include "gap/diagnosis/model/turned_motion.h"
#include "gap/diagnosis/model/window_model.h"

namespace slipway::gap {
namespace {

using Free = sim::EffectVariant::Free;
using Values = OutsideValues;

// Of the currents of one wheel or one side, by a field that may go as far as its deviation says.
std::vector<sim::EffectVariant> of_some_wheels(const sim::RoverModel& rover, const Free& field) {
  std::vector<sim::EffectVariant> all;
  for (std::size_t k = 0; k < rover.wheels.size(); ++k)
    all.push_back(outside_variant({field}, rover.wheels[k].name, {{wheel_field(k), 1.0}}));
  for (const double side : {1.0, -1.0}) {
    const std::vector<std::size_t> wheels = wheels_of_side(rover, side);
    if (wheels.size() > 1)
      all.push_back(outside_variant({field}, side > 0.0 ? "left side" : "right side", marks_of(wheels)));
  }
  return all;
}

// A gain of all currents is the motors' torque constant.
std::vector<sim::EffectVariant> current_gains(const DriveCampaign& campaign) {
  return of_some_wheels(*campaign.rover, outside_number("gain", 0.05));
}

// A sensor's zero is off by some of its own deviations.
std::vector<sim::EffectVariant> current_offsets(const DriveCampaign& campaign) {
  constexpr double kDeviations = 3.0, kLeast_a = 0.01;
  const Free offset =
      outside_number("offset_a", std::max(kLeast_a, kDeviations * campaign.measurement_std.current_a));
  std::vector<sim::EffectVariant> all = of_some_wheels(*campaign.rover, offset);
  std::vector<std::size_t> wheels(campaign.rover->wheels.size());
  std::iota(wheels.begin(), wheels.end(), std::size_t{0});
  all.push_back(outside_variant({offset}, "all wheels", marks_of(wheels)));
  return all;
}

// Channels whose sign, unit or time may be another one. What the motion is derived from, positions and
// headings, has causes of its own.
constexpr std::array kRead{Channel::kSideSlip, Channel::kYawRate, Channel::kCurrent, Channel::kSinkage};

std::string channel_field(Channel channel) {
  return fmt::format("channel_{}", name_of(channel));
}

// That a cause acts on, of those that act on one of kRead.
Channel channel_in(const Values& values) {
  return *std::find_if(kRead.begin(), kRead.end(),
                       [&](Channel channel) { return values.contains(channel_field(channel)); });
}

std::vector<sim::EffectVariant> of_each_channel(std::span<const Channel> channels, const Free& field) {
  std::vector<sim::EffectVariant> all;
  for (const Channel channel : channels)
    all.push_back(outside_variant({field}, std::string(name_of(channel)), {{channel_field(channel), 1.0}}));
  return all;
}

// As far as another sign, of all that is read.
std::vector<sim::EffectVariant> scales(const DriveCampaign& /*campaign*/) {
  return of_each_channel(kRead, {.field = "gain", .std = 0.7, .lowest = -2.5, .highest = 2.5});
}

std::vector<sim::EffectVariant> delays(const DriveCampaign& /*campaign*/) {
  constexpr std::array kLate{Channel::kCurrent, Channel::kSinkage};
  return of_each_channel(kLate, outside_number("late_s", 1.0));
}

std::vector<sim::EffectVariant> motion_offsets(const DriveCampaign& /*campaign*/) {
  return {outside_variant({outside_number("yaw_rate_rad_s", 0.002)}, "yaw_rate"),
          outside_variant({outside_number("side_slip", 0.02)}, "side_slip")};
}

template <const auto& Fields, int Percent>
std::vector<sim::EffectVariant> gains(const DriveCampaign& /*campaign*/) {
  std::vector<Free> free;
  for (const char* field : Fields) free.push_back(outside_number(field, 0.01 * Percent));
  return {outside_variant(std::move(free))};
}
constexpr std::array kGain{"gain"};

std::vector<sim::EffectVariant> sinkage_sensor(const DriveCampaign& /*campaign*/) {
  return {outside_variant({outside_number("gain", 0.1), outside_number("offset_m", 0.002)})};
}

std::vector<sim::EffectVariant> heading_offset(const DriveCampaign& /*campaign*/) {
  return {outside_variant({outside_number("offset_rad", 0.02)})};
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

bool is_current_of(std::span<const std::size_t> wheels, const Observation& o) {
  return o.channel == Channel::kCurrent && o.wheel >= 0 &&
         std::find(wheels.begin(), wheels.end(), static_cast<std::size_t>(o.wheel)) != wheels.end();
}

void show_current_gain(const Values& values, const WindowModel& model, std::vector<double>& predicted) {
  const std::vector<std::size_t> wheels = wheels_in(values);
  for_each_reading(model, predicted, [&](std::size_t, const Observation& o, double& value) {
    if (is_current_of(wheels, o)) value *= 1.0 + values.at("gain");
  });
}

void show_current_offset(const Values& values, const WindowModel& model, std::vector<double>& predicted) {
  const std::vector<std::size_t> wheels = wheels_in(values);
  for_each_reading(model, predicted, [&](std::size_t, const Observation& o, double& value) {
    const bool is_mean = o.channel == Channel::kCurrent && o.wheel < 0;
    if (is_mean || is_current_of(wheels, o)) value += values.at("offset_a");
  });
}

void show_motion_offset(const Values& values, const WindowModel& model, std::vector<double>& predicted) {
  const auto of = [&](const char* field) { return values.contains(field) ? values.at(field) : 0.0; };
  for_each_reading(model, predicted, [&](std::size_t, const Observation& o, double& value) {
    if (o.channel == Channel::kYawRate) value += of("yaw_rate_rad_s");
    if (o.channel == Channel::kSideSlip) value += of("side_slip");
  });
}

// Yaw rates are minus the commanded one in the channel, and not in what a sensor reads.
void show_scale(const Values& values, const WindowModel& model, std::vector<double>& predicted) {
  const Channel channel = channel_in(values);
  for_each_reading(model, predicted, [&](std::size_t w, const Observation& o, double& value) {
    if (o.channel != channel) return;
    const sim::DriveCommand& command = model.windows()[w].command;
    const double commanded = o.channel == Channel::kYawRate ? command.speed_m_s * command.curvature_1_m : 0.0;
    value += values.at("gain") * (value + commanded);
  });
}

// Between the middles of a drive's windows readings are taken to change evenly.
void show_delay(const Values& values, const WindowModel& model, std::vector<double>& predicted) {
  const Channel channel = channel_in(values);
  const std::vector<double> in_time = predicted;
  const auto windows = model.windows();
  const auto reading_of = [&](std::size_t w, const Observation& of) {
    for (std::size_t i = 0; i < windows[w].observations.size(); ++i)
      if (windows[w].observations[i].channel == of.channel && windows[w].observations[i].wheel == of.wheel)
        return in_time[model.offset(w) + i];
    return kNotMeasured;
  };
  for_each_reading(model, predicted, [&](std::size_t w, const Observation& o, double& value) {
    if (o.channel != channel) return;
    // From the window before where it is late, from the one behind where it is early.
    const bool late = values.at("late_s") >= 0.0;
    if (late ? w == 0 : w + 1 == windows.size()) return;
    const std::size_t other = late ? w - 1 : w + 1;
    if (windows[other].drive != windows[w].drive) return;
    const double apart = std::abs(windows[w].mid_s() - windows[other].mid_s());
    const double change = reading_of(other, o) - value;
    if (apart > 0.0 && std::isfinite(change)) value += std::abs(values.at("late_s")) / apart * change;
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
    if (model.windows()[w].command.turn_in_place) return;
    if (o.channel == Channel::kSlip) value -= values.at("gain") * (1.0 - value);
    if (o.channel == Channel::kSideSlip) value *= 1.0 + values.at("gain");
  });
}

void show_sinkage(const Values& values, const WindowModel& model, std::vector<double>& predicted) {
  for_each_reading(model, predicted, [&](std::size_t, const Observation& o, double& value) {
    if (o.channel == Channel::kSinkage) value = (1.0 + values.at("gain")) * value + values.at("offset_m");
  });
}

HeadingError heading_gain_error(const Values& values) {
  return {.gain = values.at("gain")};
}

HeadingError heading_offset_error(const Values& values) {
  return {.offset_rad = values.at("offset_rad")};
}

// The rover stands along the true headings ...
template <HeadingError (*error_of)(const Values&)>
void turn_back(const Values& values, ModelState& state) {
  const HeadingError error = error_of(values);
  state.heading_error.gain += error.gain;
  state.heading_error.offset_rad += error.offset_rad;
}

// ... and motion is read along the recorded ones.
template <HeadingError (*error_of)(const Values&)>
void show_headings(const Values& values, const WindowModel& model, std::vector<double>& predicted) {
  const HeadingError error = error_of(values);
  for_each_reading(model, predicted, [&](std::size_t w, const Observation& o, double& value) {
    const sim::DriveCommand& command = model.windows()[w].command;
    if (command.turn_in_place && o.channel == Channel::kSlip) value -= error.gain * (1.0 - value);
    if (o.channel == Channel::kYawRate)
      value += error.gain * (value + command.speed_m_s * command.curvature_1_m);
  });
  for (std::size_t w = 0; w < model.windows().size(); ++w) {
    const DriveWindow& window = model.windows()[w];
    read_along_turned_heading(model, w, error.off_rad(window.middle().yaw_rad - window.first_yaw_rad),
                              predicted);
  }
}

std::string percent(double share) {
  return fmt::format("{:.1f} % {}", 100.0 * std::abs(share), share < 0.0 ? "less" : "more");
}

std::string current_words(const Values& v, const DriveCampaign& campaign) {
  return fmt::format("the current of {} reads {}", names_of_wheels(*campaign.rover, wheels_in(v)),
                     percent(v.at("gain")));
}

std::string current_offset_words(const Values& v, const DriveCampaign& campaign) {
  return fmt::format("the current of {} reads {:.3g} A too {}",
                     names_of_wheels(*campaign.rover, wheels_in(v)), std::abs(v.at("offset_a")),
                     v.at("offset_a") < 0.0 ? "low" : "high");
}

std::string motion_offset_words(const Values& v, const DriveCampaign& /*campaign*/) {
  const bool of_side_slip = v.contains("side_slip");
  const double off = of_side_slip ? v.at("side_slip") : deg_from_rad(v.at("yaw_rate_rad_s"));
  return fmt::format("{} read {:.3g}{} too far to the {}", of_side_slip ? "side slips" : "yaw rates",
                     std::abs(off), of_side_slip ? "" : " deg/s", off < 0.0 ? "right" : "left");
}

std::string scale_words(const Values& v, const DriveCampaign& /*campaign*/) {
  const double times = 1.0 + v.at("gain");
  return fmt::format("readings of {} are {:.3g} times what they should be{}", name_of(channel_in(v)), times,
                     times < 0.0 ? ": they have the wrong sign" : "");
}

std::string delay_words(const Values& v, const DriveCampaign& /*campaign*/) {
  return fmt::format("readings of {} come {:.2g} s {} than the positions", name_of(channel_in(v)),
                     std::abs(v.at("late_s")), v.at("late_s") < 0.0 ? "earlier" : "later");
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

constexpr std::array kSensorRows{
    OutsideCause{.name = "current_gain",
                 .form = "sensor",
                 .entry = "torque_to_current",
                 .depends = "constant",
                 .unit = "1",
                 .variants = &current_gains,
                 .show = &show_current_gain,
                 .words = &current_words},
    OutsideCause{.name = "current_offset",
                 .form = "sensor",
                 .entry = "torque_to_current",
                 .depends = "constant",
                 .unit = "A",
                 .variants = &current_offsets,
                 .show = &show_current_offset,
                 .words = &current_offset_words,
                 .twin_of_an_effect = true},
    OutsideCause{.name = "motion_offset",
                 .form = "sensor",
                 .entry = "yaw",
                 .depends = "constant",
                 .unit = "1",
                 .variants = &motion_offsets,
                 .show = &show_motion_offset,
                 .words = &motion_offset_words,
                 .has_shape = false},
    OutsideCause{.name = "wrong_scale",
                 .form = "sensor",
                 .entry = "reading",
                 .depends = "constant",
                 .unit = "1",
                 .variants = &scales,
                 .show = &show_scale,
                 .words = &scale_words},
    OutsideCause{.name = "late_reading",
                 .form = "sensor",
                 .entry = "reading",
                 .depends = "time",
                 .unit = "s",
                 .variants = &delays,
                 .show = &show_delay,
                 .words = &delay_words,
                 .has_shape = false},
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
                 .act = &turn_back<&heading_gain_error>,
                 .show = &show_headings<&heading_gain_error>,
                 .words = &heading_words},
    OutsideCause{.name = "heading_offset",
                 .form = "sensor",
                 .entry = "side_slip",
                 .depends = "direction",
                 .unit = "rad",
                 .variants = &heading_offset,
                 .act = &turn_back<&heading_offset_error>,
                 .show = &show_headings<&heading_offset_error>,
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

std::span<const OutsideCause> outside_sensor_rows() {
  return kSensorRows;
}

}  // namespace slipway::gap
