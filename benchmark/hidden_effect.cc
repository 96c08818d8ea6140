#include "benchmark/hidden_effect.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/random.h"

namespace slipway::campaign {
namespace {

struct Draw {
  double size = 1.0;
  std::uint64_t key = 0;
  const sim::RoverModel& rover;

  double sign(std::uint64_t counter) const { return random_bits(key, counter) % 2 == 0 ? 1.0 : -1.0; }
  // In steps of a hundredth of the range.
  double between(double lowest, double highest, std::uint64_t counter) const {
    return lowest + 0.01 * (highest - lowest) * static_cast<double>(random_bits(key, counter) % 101);
  }
};

using Parameters = std::map<std::string, double>;

Parameters com_offset(const Draw& d) {
  return {{"x_m", d.sign(0) * 0.06 * d.size}, {"y_m", d.sign(1) * 0.03 * d.size}};
}

Parameters motor_temperature(const Draw& d) {
  return {{"kt_per_k", 0.0011 * d.size}, {"friction_per_k", std::min(0.02 * d.size, 0.03)}};
}

Parameters dragging_wheel(const Draw& d) {
  const double share = d.size < 1.0 ? 1.0 : d.size < 2.0 ? 0.85 : 0.4;
  return {{"wheel", static_cast<double>(random_bits(d.key, 0) % d.rover.wheels.size())},
          {"rate_share", share},
          {"drag_nm", 2.0 * d.size}};
}

// All that steer, or one.
Parameters steering_offset(const Draw& d) {
  std::vector<std::size_t> steered;
  for (std::size_t k = 0; k < d.rover.wheels.size(); ++k)
    if (d.rover.wheels[k].steerable) steered.push_back(k);
  const bool one = !steered.empty() && random_uniform(d.key, 1) < 0.4;
  const double wheel = one ? static_cast<double>(steered[random_bits(d.key, 2) % steered.size()]) : -1.0;
  return {{"angle_deg", d.sign(0) * 2.0 * d.size}, {"wheel", wheel}};
}

Parameters soft_patch(const Draw& d) {
  return {{"weakening", d.size < 1.0 ? 0.2 : d.size < 2.0 ? 0.4 : 0.6}, {"radius_m", d.between(2.0, 3.2, 0)}};
}

struct Row {
  std::string_view name;
  Parameters (*parameters)(const Draw& draw);
};

// The usual sizes are the effect catalogue's, or of its order where that has none.
constexpr std::array kRows{
    Row{"slip_sinkage",
        [](const Draw& d) {
          return Parameters{{"n1", 0.3 * d.size}};
        }},
    Row{"multipass",
        [](const Draw& d) {
          return Parameters{{"stiffening", 0.9 * d.size}};
        }},
    Row{"grousers",
        [](const Draw& d) {
          return Parameters{{"height_m", 0.01 * d.size}, {"count", 24.0}};
        }},
    Row{"bulldozing",
        [](const Draw& d) {
          return Parameters{{"share", d.size}};
        }},
    Row{"side_bulldozing",
        [](const Draw& d) {
          return Parameters{{"share", d.size}};
        }},
    Row{"com_offset", &com_offset},
    Row{"motor_temperature", &motor_temperature},
    Row{"gearbox_friction",
        [](const Draw& d) {
          return Parameters{{"torque_nm", 0.5 * d.size}};
        }},
    Row{"wheel_radius",
        [](const Draw& d) {
          return Parameters{{"scale", d.sign(0) * 0.03 * d.size}};
        }},
    Row{"dragging_wheel", &dragging_wheel},
    Row{"rate_shear",
        [](const Draw& d) {
          return Parameters{{"exponent", 0.3 * d.size}};
        }},
    Row{"duricrust",
        [](const Draw& d) {
          return Parameters{{"strength_pa", 5000.0 * d.size}, {"depth_m", 0.005}};
        }},
    Row{"hardpan",
        [](const Draw& d) {
          return Parameters{{"modulus_pa_m", 1e6 * d.size}, {"depth_m", d.between(0.006, 0.010, 0)}};
        }},
    Row{"soft_patch", &soft_patch},
    Row{"steering_offset", &steering_offset},
    Row{"attitude_bias", [](const Draw& d) {
          return Parameters{{"pitch_deg", d.sign(0) * d.size}, {"roll_deg", d.sign(1) * 0.5 * d.size}};
        }}};

constexpr auto kNames = [] {
  std::array<std::string_view, kRows.size()> names{};
  for (std::size_t i = 0; i < kRows.size(); ++i) names[i] = kRows[i].name;
  return names;
}();

}  // namespace

std::span<const std::string_view> hidden_effects() {
  return kNames;
}

sim::EffectSetting hidden_effect(std::string_view name, double size, std::uint64_t key,
                                 const sim::RoverModel& rover) {
  const auto row = std::find_if(kRows.begin(), kRows.end(), [&](const Row& r) { return r.name == name; });
  return {std::string(name), row->parameters({size, key, rover})};
}

}  // namespace slipway::campaign
