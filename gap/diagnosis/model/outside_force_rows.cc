#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "core/angle.h"
#include "gap/diagnosis/model/outside_cause_rows.h"
#include "gap/diagnosis/model/window_model.h"

namespace slipway::gap {
namespace {

using Free = sim::EffectVariant::Free;
using Values = OutsideValues;

// Prior deviation of a force, of the rover's weight: what a slope of 1.7 deg does.
constexpr double kForceShare = 0.03;
constexpr double kWheelForceShare = 0.015;
constexpr double kLoadShare = 0.05;

double weight_n(const DriveCampaign& campaign) {
  return campaign.rover->mass_kg * campaign.gravity_m_s2;
}

// Where on the body a force acts: at the ground or well above the deck, and ahead of the centre of mass.
constexpr const char* kHeight = "height_m";
constexpr const char* kAhead = "ahead_m";

Free place(const char* field) {
  return {.field = field, .std = 0.15, .lowest = -0.6, .highest = 0.6};
}

// One way, with these fields free, each of one deviation: a share of the weight; and the place.
template <const auto& Fields, const auto& Places>
std::vector<sim::EffectVariant> forces(const DriveCampaign& campaign) {
  std::vector<Free> free;
  for (const char* field : Fields) free.push_back(outside_number(field, kForceShare * weight_n(campaign)));
  for (const char* field : Places) free.push_back(place(field));
  return {outside_variant(std::move(free))};
}
constexpr std::array kForce{"force_n"};
constexpr std::array kForwardLeft{"forward_n", "left_n"};
constexpr std::array kMapXY{"x_n", "y_n"};
constexpr std::array kUp{kHeight};
// A push to the side turns the rover where it does not act at the centre of mass.
constexpr std::array kUpAndAhead{kHeight, kAhead};

std::vector<sim::EffectVariant> load(const DriveCampaign& campaign) {
  return {outside_variant({outside_number("force_n", kLoadShare * weight_n(campaign))})};
}

std::vector<sim::EffectVariant> turning(const DriveCampaign& campaign) {
  return {outside_variant(
      {outside_number("moment_nm", kForceShare * weight_n(campaign) * 0.5 * campaign.rover->track_m())})};
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

// Each axle as a whole: its wheels are fixed, the force is that of each of them.
std::vector<sim::EffectVariant> axle_forces(const DriveCampaign& campaign) {
  std::vector<sim::EffectVariant> all;
  for (const std::vector<std::size_t>& wheels : axles_of(*campaign.rover)) {
    if (wheels.size() < 2) continue;
    all.push_back(outside_variant({outside_number("force_n", kWheelForceShare * weight_n(campaign))},
                                  names_of_wheels(*campaign.rover, wheels), marks_of(wheels)));
  }
  return all;
}

std::vector<sim::EffectVariant> wheel_forces(const DriveCampaign& campaign) {
  std::vector<sim::EffectVariant> all;
  for (std::size_t k = 0; k < campaign.rover->wheels.size(); ++k)
    all.push_back(outside_variant({outside_number("force_n", kForceShare * weight_n(campaign))},
                                  campaign.rover->wheels[k].name, {{wheel_field(k), 1.0}}));
  return all;
}

// At each of the wheels, times the number that its field has.
template <int Axis>
void force_at_wheels(const Values& values, ModelState& state) {
  for (const std::size_t k : wheels_in(values))
    state.outside.at_wheel_n.try_emplace(k, Eigen::Vector3d::Zero()).first->second[Axis] +=
        values.at(wheel_field(k)) * values.at("force_n");
}

// Moments about joints of the suspension put weight from some wheels on others and leave force and moment of
// the whole as they are: of three wheels of a side the middle one against the outer ones, of four wheels one
// diagonal against the other.
std::vector<sim::EffectVariant> shifts_within_suspension(const DriveCampaign& campaign) {
  const sim::RoverModel& rover = *campaign.rover;
  const Free force = outside_number("force_n", kWheelForceShare * weight_n(campaign));
  std::vector<sim::EffectVariant> all;
  for (const double side : {1.0, -1.0}) {
    std::vector<std::size_t> wheels = wheels_of_side(rover, side);
    std::sort(wheels.begin(), wheels.end(), [&](std::size_t a, std::size_t b) {
      return rover.wheels[a].position_m.x() > rover.wheels[b].position_m.x();
    });
    if (wheels.size() != 3) continue;
    const auto x = [&](std::size_t i) { return rover.wheels[wheels[i]].position_m.x(); };
    if (!(x(0) > x(1) && x(1) > x(2))) continue;
    const double front = (x(1) - x(2)) / (x(0) - x(2));
    all.push_back(outside_variant({force}, side > 0.0 ? "left side" : "right side",
                                  {{wheel_field(wheels[0]), front},
                                   {wheel_field(wheels[1]), -1.0},
                                   {wheel_field(wheels[2]), 1.0 - front}}));
  }
  if (!all.empty() || rover.wheels.size() != 4) return all;
  std::vector<std::pair<std::string, double>> diagonals;
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector3d& at = rover.wheels[k].position_m;
    diagonals.emplace_back(wheel_field(k), (at.x() > 0.0) == (at.y() > 0.0) ? 1.0 : -1.0);
  }
  return {outside_variant({force}, "diagonals", std::move(diagonals))};
}

void shift_within_suspension(const Values& values, ModelState& state) {
  force_at_wheels<2>(values, state);
  // Wheels of a side need not stand in one line.
  for (const std::size_t k : wheels_in(values))
    state.outside.moment_nm -= state.rover.wheels[k].position_m.cross(Eigen::Vector3d::UnitZ()) *
                               (values.at(wheel_field(k)) * values.at("force_n"));
}

std::vector<sim::EffectVariant> tilting(const DriveCampaign& campaign) {
  const double std = kForceShare * weight_n(campaign) * 0.5 * campaign.rover->track_m();
  return {outside_variant({outside_number("roll_nm", std), outside_number("pitch_nm", std)})};
}

std::string suspension_words(const Values& v, const DriveCampaign& campaign) {
  std::vector<std::size_t> more, less;
  for (const std::size_t k : wheels_in(v))
    (v.at(wheel_field(k)) * v.at("force_n") < 0.0 ? more : less).push_back(k);
  return fmt::format("a moment inside the suspension puts {:.3g} N more on {} and as much less on {}",
                     std::abs(v.at("force_n")), names_of_wheels(*campaign.rover, more),
                     names_of_wheels(*campaign.rover, less));
}

std::string tilting_words(const Values& v, const DriveCampaign& /*campaign*/) {
  return fmt::format(
      "a steady moment on the body, {:.3g} N m about its length and {:.3g} N m about its width",
      v.at("roll_nm"), v.at("pitch_nm"));
}

std::string axle_side_words(const Values& v, const DriveCampaign& campaign) {
  return fmt::format("a steady push of {:.3g} N to the {}, at each of the axles of {}",
                     std::abs(v.at("force_n")), v.at("force_n") < 0.0 ? "right" : "left",
                     names_of_wheels(*campaign.rover, wheels_in(v)));
}

std::string along_words(double force_n) {
  return force_n < 0.0 ? "against the travel" : "with the travel";
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

constexpr std::array kForceRows{
    OutsideCause{.name = "pull_along_travel",
                 .form = "force_on_body",
                 .entry = "tangential_force",
                 .depends = "direction",
                 .unit = "N",
                 .variants = &forces<kForce, kUp>,
                 .act =
                     [](const Values& v, ModelState& s) {
                       s.outside.along_n += v.at("force_n");
                       s.outside.height_m = v.at(kHeight);
                     },
                 .words = &pull_words},
    OutsideCause{.name = "push_on_map",
                 .form = "force_on_body",
                 .entry = "tangential_force",
                 .depends = "heading",
                 .unit = "N",
                 .variants = &forces<kMapXY, kUpAndAhead>,
                 .act =
                     [](const Values& v, ModelState& s) {
                       s.outside.on_map_n += Eigen::Vector2d(v.at("x_n"), v.at("y_n"));
                       s.outside.height_m = v.at(kHeight);
                       s.outside.ahead_m = v.at(kAhead);
                     },
                 .words = &push_words},
    OutsideCause{.name = "push_in_body",
                 .form = "force_on_body",
                 .entry = "lateral_force",
                 .depends = "constant",
                 .unit = "N",
                 .variants = &forces<kForwardLeft, kUpAndAhead>,
                 .act =
                     [](const Values& v, ModelState& s) {
                       s.outside.in_body_n += Eigen::Vector2d(v.at("forward_n"), v.at("left_n"));
                       s.outside.height_m = v.at(kHeight);
                       s.outside.ahead_m = v.at(kAhead);
                     },
                 .words = &body_words,
                 .twin_of_an_effect = true},
    OutsideCause{.name = "pull_with_speed",
                 .form = "force_on_body",
                 .entry = "tangential_force",
                 .depends = "speed",
                 .unit = "N",
                 .variants = &forces<kForce, kUp>,
                 .act =
                     [](const Values& v, ModelState& s) {
                       s.outside.along_by_speed_n += v.at("force_n");
                       s.outside.height_m = v.at(kHeight);
                     },
                 .words = &speed_words},
    OutsideCause{.name = "pull_with_slope",
                 .form = "force_on_body",
                 .entry = "tangential_force",
                 .depends = "pitch",
                 .unit = "N",
                 .variants = &forces<kForce, kUp>,
                 .act =
                     [](const Values& v, ModelState& s) {
                       s.outside.along_by_slope_n += v.at("force_n");
                       s.outside.height_m = v.at(kHeight);
                     },
                 .words = &slope_words},
    OutsideCause{.name = "load",
                 .form = "force_on_body",
                 .entry = "wheel_load",
                 .depends = "constant",
                 .unit = "N",
                 .variants = &load,
                 .act = [](const Values& v, ModelState& s) { s.outside.load_n += v.at("force_n"); },
                 .words = &load_words},
    OutsideCause{.name = "turning_moment",
                 .form = "moment_on_body",
                 .entry = "yaw",
                 .depends = "constant",
                 .unit = "N m",
                 .variants = &turning,
                 .act = [](const Values& v, ModelState& s) { s.outside.moment_nm.z() += v.at("moment_nm"); },
                 .words = &turning_words},
    OutsideCause{.name = "pull_at_axle",
                 .form = "force_at_axle",
                 .entry = "tangential_force",
                 .depends = "direction",
                 .unit = "N",
                 .variants = &axle_forces,
                 .act = &force_at_wheels<0>,
                 .words = &wheel_words},
    OutsideCause{.name = "pull_at_wheel",
                 .form = "force_at_wheel",
                 .entry = "tangential_force",
                 .depends = "direction",
                 .unit = "N",
                 .variants = &wheel_forces,
                 .act = &force_at_wheels<0>,
                 .words = &wheel_words},
    OutsideCause{.name = "push_at_axle",
                 .form = "force_at_axle",
                 .entry = "lateral_force",
                 .depends = "constant",
                 .unit = "N",
                 .variants = &axle_forces,
                 .act = &force_at_wheels<1>,
                 .words = &axle_side_words},
    OutsideCause{.name = "tilting_moment",
                 .form = "moment_on_body",
                 .entry = "wheel_load",
                 .depends = "constant",
                 .unit = "N m",
                 .variants = &tilting,
                 .act =
                     [](const Values& v, ModelState& s) {
                       s.outside.moment_nm += Eigen::Vector3d(v.at("roll_nm"), v.at("pitch_nm"), 0.0);
                     },
                 .words = &tilting_words,
                 .has_shape = false,
                 .twin_of_an_effect = true},
    OutsideCause{.name = "moment_inside_suspension",
                 .form = "force_at_wheel",
                 .entry = "wheel_load",
                 .depends = "constant",
                 .unit = "N",
                 .variants = &shifts_within_suspension,
                 .act = &shift_within_suspension,
                 .words = &suspension_words},
};

}  // namespace

std::span<const OutsideCause> outside_force_rows() {
  return kForceRows;
}

}  // namespace slipway::gap
