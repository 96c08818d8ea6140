#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.h"
#include "gap/diagnosis/model/outside_cause_rows.h"
#include "gap/diagnosis/model/turned_motion.h"
#include "gap/diagnosis/model/window_model.h"

namespace slipway::gap {
namespace {

using Free = sim::EffectVariant::Free;
using Values = OutsideValues;

// A gain of one wheel's current alone; one of all is the motors' torque constant.
std::vector<sim::EffectVariant> current_gains(const DriveCampaign& campaign) {
  std::vector<sim::EffectVariant> all;
  for (std::size_t k = 0; k < campaign.rover->wheels.size(); ++k)
    all.push_back(outside_variant({outside_number("gain", 0.05)}, campaign.rover->wheels[k].name,
                                  {{wheel_field(k), 1.0}}));
  return all;
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
