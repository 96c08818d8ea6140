#pragma once

#include <Eigen/Core>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnosis/model/drive_campaign.h"
#include "sim/effects/effect.h"
#include "sim/quasi_static/outside_wrench.h"
#include "sim/rover/stance.h"
#include "sim/soil/soil.h"

namespace slipway::gap {

class WindowModel;
struct ModelState;

// What an unmodelled world does to a vehicle, all at once; every window makes it a wrench of its own. N and
// N m. "Along" is the direction of travel, so that a force along of less than 0 holds the rover back either
// way; none acts while the rover turns in place.
struct OutsideForces {
  double along_n = 0.0;
  double along_by_speed_n = 0.0;  // at the rover's cruise speed, in proportion to the commanded speed
  double along_by_slope_n = 0.0;  // to the body's front, in proportion to the sine of the climb, at 10 deg
  Eigen::Vector2d in_body_n = Eigen::Vector2d::Zero();  // forward and to the left
  Eigen::Vector2d on_map_n = Eigen::Vector2d::Zero();   // towards the map's x and y
  double load_n = 0.0;                                  // downward
  // Of the point where these act on the body, from the centre of mass.
  double height_m = 0.0, ahead_m = 0.0;
  Eigen::Vector3d moment_nm = Eigen::Vector3d::Zero();  // on the body, about its own axes
  // At the axles, by the wheel's index: along the travel, to the body's left, and up in the body.
  std::map<std::size_t, Eigen::Vector3d> at_wheel_n;

  bool any() const;
};

// Where on a campaign's ground, and when: what the strength of all soils may go with.
struct SoilPlace {
  double order = 0.0;  // of the drive: -1 of the first, and of the only one, to 1 of the last
  double along = 0.0;  // along the drive, in time: -1 at its start to 1 at its end
  Eigen::Vector2d on_map = {0.0, 0.0};  // -1 to 1 over the extent of all drives, each way
};

// How the strength of all soils changes: from drive to drive, as by the sun or by moisture, along each drive,
// and over the map. Cohesion and tan(friction angle) are taken times
// 1 + last (t + 1) / 2 + middle (1 - t^2) + end a + over (x, y), with t the order, a along and (x, y) on_map.
struct SoilDrift {
  double last = 0.0, middle = 0.0, end = 0.0;
  Eigen::Vector2d over = {0, 0};

  bool any() const { return last != 0.0 || middle != 0.0 || end != 0.0 || !over.isZero(0.0); }
  double factor(const SoilPlace& at) const;
};
// Cohesion and tan(friction angle) of a soil times this.
void strengthen(sim::Soil& soil, double factor);

// How recorded headings err, by a scale factor and a bias: changes since a drive began are recorded as
// 1 + gain of what they are, and all headings too far to the left by an offset.
struct HeadingError {
  double gain = 0.0, offset_rad = 0.0;

  bool any() const { return gain != 0.0 || offset_rad != 0.0; }
  // What is recorded less what is true, where the recorded heading has turned this far since the drive began.
  double off_rad(double turned_rad) const { return gain / (1.0 + gain) * turned_rad + offset_rad; }
  bool operator==(const HeadingError&) const = default;
};

// Forces on the body act in the plane through its centre of mass that parts left from right, those at wheels
// at the axles.
sim::OutsideWrench wrench_of(const OutsideForces& forces, const sim::RoverModel& rover,
                             const sim::Stance& stance, const sim::DriveCommand& command);

using OutsideValues = std::map<std::string, double>;  // of a cause's fields, by name

// A cause outside the simulator and its library: a force that the world puts on the vehicle, soil that
// changes from drive to drive, a part that does not do what is measured of it, or a sensor that reads in
// another scale or from another zero. In a diagnosis it competes as the library's effects do, with parameters
// of its own that are fitted in full, and is told as the form of something unknown.
struct OutsideCause {
  std::string_view name;     // "pull_along_travel"
  std::string_view form;     // one of those of a residual in api/openapi.json: "force_on_body", "sensor", ...
  std::string_view entry;    // where it enters: "tangential_force", "wheel_rate", "soil_strength", ...
  std::string_view depends;  // on which circumstance
  std::string_view unit;     // of its fields
  // The ways in which it could be at work. Prior deviations of forces are shares of the rover's weight.
  std::vector<sim::EffectVariant> (*variants)(const DriveCampaign& campaign);
  // One of these two, or both. The first changes what the model predicts from: forces, rover, soils or where
  // the rover stands.
  void (*act)(const OutsideValues& values, ModelState& state) = nullptr;
  // Turns predictions into what the wrong sensor would show.
  void (*show)(const OutsideValues& values, const WindowModel& model,
               std::vector<double>& predicted) = nullptr;
  // "a steady pull of 25 N against the travel, at the body"
  std::string (*words)(const OutsideValues& values, const DriveCampaign& campaign);
  // Whether what it does is its first field times the circumstance it depends on: then that is told as a
  // shape.
  bool has_shape = true;
  // Whether the library holds an effect that is the same in every drive, so that this one gets a small part
  // of the prior only.
  bool twin_of_an_effect = false;
};

std::span<const OutsideCause> outside_catalogue();
const OutsideCause* find_outside(std::string_view name);  // null where there is none of this name
bool is_outside(std::string_view name);

// All variants of all causes on a campaign's rover.
std::vector<sim::EffectVariant> outside_variants(const DriveCampaign& campaign);

}  // namespace slipway::gap
