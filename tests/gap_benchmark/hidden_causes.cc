#include "hidden_causes.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace slipway::gap_benchmark {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

using Answer = std::map<std::string, double>;
using Hide = void (*)(double size, RandomStream& random, HiddenTruth& truth, Answer& answer);

double sign_of(RandomStream& random) {
  return random.uniform() < 0.5 ? -1.0 : 1.0;
}

struct Row {
  std::string_view name;
  bool in_library;
  Hide hide;
};

constexpr std::array kRows{
    Row{"slip_sinkage", true,
        [](double size, RandomStream&, HiddenTruth& t, Answer& a) { a["n1"] = t.slip_sinkage = 0.3 * size; }},
    Row{"multipass", true,
        [](double size, RandomStream&, HiddenTruth& t, Answer& a) {
          a["stiffening"] = t.multipass = 0.9 * size;
        }},
    Row{"grousers", true,
        [](double size, RandomStream&, HiddenTruth& t, Answer& a) {
          a["height_m"] = t.grouser_height_m = 0.01 * size;
          a["count"] = t.grouser_count = 24.0;
        }},
    Row{"bulldozing", true,
        [](double size, RandomStream&, HiddenTruth& t, Answer& a) { a["share"] = t.bulldozing = size; }},
    Row{"side_bulldozing", true,
        [](double size, RandomStream&, HiddenTruth& t, Answer& a) { a["share"] = t.side_bulldozing = size; }},
    Row{"com_offset", true,
        [](double size, RandomStream& random, HiddenTruth& t, Answer& a) {
          a["x_m"] = t.com_shift_m[0] = sign_of(random) * 0.06 * size;
          a["y_m"] = t.com_shift_m[1] = sign_of(random) * 0.03 * size;
        }},
    Row{"motor_temperature", true,
        [](double size, RandomStream&, HiddenTruth& t, Answer& a) {
          a["kt_per_k"] = t.kt_per_k = 0.0011 * size;
          a["friction_per_k"] = t.friction_per_k = std::min(0.02 * size, 0.03);
        }},
    Row{"gearbox_friction", true,
        [](double size, RandomStream& random, HiddenTruth& t, Answer& a) {
          a["torque_nm"] = t.gear_torque_nm = 0.5 * size;
          if (random.uniform() < 0.5) a["viscous_nms_rad"] = t.gear_viscous_nms_rad = 0.5 * size;
        }},
    Row{"wheel_radius", true,
        [](double size, RandomStream& random, HiddenTruth& t, Answer& a) {
          a["scale"] = t.radius_scale = sign_of(random) * 0.03 * size;
        }},
    Row{"dragging_wheel", true,
        [](double size, RandomStream& random, HiddenTruth& t, Answer& a) {
          t.dragging = static_cast<int>(random.below(6));
          a["wheel"] = t.dragging;
          a["rate_share"] = t.dragging_rate_share = size < 1.0 ? 1.0 : size < 2.0 ? 0.85 : 0.4;
          a["drag_nm"] = t.dragging_nm = 2.0 * size;
        }},
    Row{"rate_shear", true,
        [](double size, RandomStream&, HiddenTruth& t, Answer& a) {
          a["exponent"] = t.rate_exponent = 0.3 * size;
        }},
    Row{"duricrust", true,
        [](double size, RandomStream&, HiddenTruth& t, Answer& a) {
          a["strength_pa"] = t.crust_pa = 5000.0 * size;
          a["depth_m"] = t.crust_depth_m = 0.005;
        }},
    Row{"hardpan", true,
        [](double size, RandomStream& random, HiddenTruth& t, Answer& a) {
          a["modulus_pa_m"] = t.hardpan_pa_m = 1.0e6 * size;
          a["depth_m"] = t.hardpan_depth_m = 0.001 * (6.0 + 0.1 * static_cast<double>(random.below(41)));
        }},
    Row{"soft_patch", true,
        [](double size, RandomStream& random, HiddenTruth& t, Answer& a) {
          a["weakening"] = t.patch_weakening = size < 1.0 ? 0.2 : size < 2.0 ? 0.4 : 0.6;
          a["radius_m"] = t.patch_radius_m = 2.0 + 0.05 * static_cast<double>(random.below(25));
        }},
    Row{"steering_offset", true,
        [](double size, RandomStream& random, HiddenTruth& t, Answer& a) {
          const double deg = sign_of(random) * 2.0 * size;
          a["angle_deg"] = deg;
          t.steering_rad = deg * kRadPerDeg;
          constexpr std::array<int, 4> kSteered{0, 2, 3, 5};
          if (random.uniform() < 0.4) t.steered = kSteered[random.below(4)];
          a["wheel"] = t.steered;
        }},
    Row{"attitude_bias", true,
        [](double size, RandomStream& random, HiddenTruth& t, Answer& a) {
          a["pitch_deg"] = sign_of(random) * size;
          a["roll_deg"] = sign_of(random) * 0.5 * size;
          t.pitch_bias_rad = a["pitch_deg"] * kRadPerDeg;
          t.roll_bias_rad = a["roll_deg"] * kRadPerDeg;
          t.bias_of_gravity = random.uniform() < 0.6;
          a["of_gravity"] = t.bias_of_gravity ? 1.0 : 0.0;
        }},
    Row{"tether", false,
        [](double size, RandomStream&, HiddenTruth& t, Answer& a) {
          a["force_n"] = t.tether_n = 25.0 * size;
        }},
    Row{"side_wind", false,
        [](double size, RandomStream& random, HiddenTruth& t, Answer& a) {
          a["force_n"] = t.wind_n = 25.0 * size;
          a["toward_deg"] = 5.0 * static_cast<double>(random.below(72));
          t.wind_rad = a["toward_deg"] * kRadPerDeg;
        }},
    Row{"odometry_yaw_scale", false,
        [](double size, RandomStream& random, HiddenTruth& t, Answer& a) {
          a["scale"] = t.odometry_yaw_scale = sign_of(random) * 0.06 * size;
        }},
    Row{"current_gain_drift", false,
        [](double size, RandomStream& random, HiddenTruth& t, Answer& a) {
          a["over_all_drives"] = t.current_gain_drift = sign_of(random) * 0.15 * size;
        }},
    Row{"slipping_hub", false,
        [](double size, RandomStream& random, HiddenTruth& t, Answer& a) {
          t.slipping_hub = static_cast<int>(random.below(6));
          a["wheel"] = t.slipping_hub;
          a["greatest_share"] = t.hub_share = std::min(0.3 * size, 0.8);
        }},
    Row{"solar_softening", false,
        [](double size, RandomStream&, HiddenTruth& t, Answer& a) {
          a["share_at_noon"] = t.solar_softening = std::min(0.12 * size, 0.2);
        }},
    Row{"body_push", false,
        [](double size, RandomStream& random, HiddenTruth& t, Answer& a) {
          a["forward_n"] = t.push_forward_n = 10.0 * size * sign_of(random);
          a["left_n"] = t.push_left_n = 25.0 * size * sign_of(random);
        }},
    Row{"speed_drag", false,
        [](double size, RandomStream&, HiddenTruth& t, Answer& a) {
          a["force_n_at_0.04_m_s"] = t.speed_drag_n = 30.0 * size;
        }},
    Row{"slope_drag", false,
        [](double size, RandomStream&, HiddenTruth& t, Answer& a) {
          a["force_n_at_10_deg"] = t.slope_drag_n = 25.0 * size;
        }},
    Row{"axle_drag", false,
        [](double size, RandomStream& random, HiddenTruth& t, Answer& a) {
          t.dragged_axle = static_cast<int>(random.below(3));
          a["axle"] = t.dragged_axle;
          a["force_n"] = t.axle_drag_n = 15.0 * size;
        }},
    Row{"wheel_snag", false,
        [](double size, RandomStream& random, HiddenTruth& t, Answer& a) {
          t.snagged_wheel = static_cast<int>(random.below(6));
          a["wheel"] = t.snagged_wheel;
          a["force_n"] = t.wheel_drag_n = 25.0 * size;
        }},
    Row{"wheel_current_gain", false,
        [](double size, RandomStream& random, HiddenTruth& t, Answer& a) {
          t.gained_wheel = static_cast<int>(random.below(6));
          a["wheel"] = t.gained_wheel;
          a["gain"] = t.wheel_current_gain = sign_of(random) * 0.12 * size;
        }},
};

constexpr std::size_t kInLibrary = 16, kForeignRows = 6;

template <std::size_t From, std::size_t Count>
constexpr std::array<std::string_view, Count> names() {
  std::array<std::string_view, Count> out{};
  for (std::size_t i = 0; i < Count; ++i) out[i] = kRows[From + i].name;
  return out;
}
constexpr auto kLibrary = names<0, kInLibrary>();
constexpr auto kForeign = names<kInLibrary, kForeignRows>();
constexpr auto kWorld = names<kInLibrary + kForeignRows, kRows.size() - kInLibrary - kForeignRows>();

}  // namespace

std::span<const std::string_view> library_effects() {
  return kLibrary;
}

std::span<const std::string_view> foreign_causes() {
  return kForeign;
}

std::span<const std::string_view> world_causes() {
  return kWorld;
}

bool is_known_cause(std::string_view name) {
  return std::any_of(kRows.begin(), kRows.end(), [&](const Row& row) { return row.name == name; });
}

bool is_of_arc_law(std::string_view name) {
  constexpr std::array<std::string_view, 7> kOfArcLaw{
      "slip_sinkage", "multipass", "grousers", "bulldozing", "side_bulldozing", "duricrust", "hardpan"};
  return std::find(kOfArcLaw.begin(), kOfArcLaw.end(), name) != kOfArcLaw.end();
}

void hide(std::string_view name, double size, RandomStream& random, HiddenTruth& truth,
          EffectAnswers& answer) {
  for (const Row& row : kRows)
    if (row.name == name) row.hide(size, random, truth, answer[std::string(name)]);
}

}  // namespace slipway::gap_benchmark
