#include "api/files/rover_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "api/files/effect_settings.h"
#include "api/files/model_fields.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "sim/effects/effect_catalogue.h"
#include "sim/rover/rover_field.h"
#include "sim/wheel/sliced_wheel.h"

namespace slipway::api::json {
namespace {

constexpr NumberRule kBodyMetres{"m", -10.0, 10.0};
constexpr std::size_t kMaxSources = 50;

// In the order of sim::WheelDrive and sim::SuspensionType.
const std::vector<std::string_view> kWheelDrives{"driven", "locked", "free"};
const std::vector<std::string_view> kSuspensions{"rocker_bogie", "averaging", "rigid"};

constexpr std::array<std::string_view, 6> kUsualWheels{"lf", "lm", "lr", "rf", "rm", "rr"};

bool read_point(ObjectReader& reader, std::string_view key, Eigen::Vector3d& out) {
  std::vector<double> xyz;
  if (!reader.numbers(key, kRequired, {3, 3}, kBodyMetres, xyz)) return false;
  out = Eigen::Vector3d(xyz[0], xyz[1], xyz[2]);
  return true;
}

std::optional<sim::Grousers> read_grousers(ObjectReader& reader) {
  auto object = reader.object("grousers", kOptional);
  if (!object) return std::nullopt;
  sim::Grousers grousers;
  read_fields(*object, sim::grouser_fields(), kRequired, grousers);
  object->refuse_unknown();
  return grousers;
}

// The usual names say the side; of other wheels their place does.
sim::Side side_of(const sim::WheelModel& wheel) {
  const bool usual = std::find(kUsualWheels.begin(), kUsualWheels.end(), wheel.name) != kUsualWheels.end();
  const bool right = usual ? wheel.name.starts_with('r') : wheel.position_m.y() < 0.0;
  return right ? sim::Side::kRight : sim::Side::kLeft;
}

void read_wheels(ObjectReader& reader, sim::RoverModel& rover) {
  reader.whole("wheel_slices", kOptional, 1, sim::kMaxSlices, rover.wheel_slices);
  // Given for the rover, they are on every wheel that has none of its own.
  const std::optional<sim::Grousers> everywhere = read_grousers(reader);
  for (const Element& element : reader.list("wheels", kRequired, {3, sim::kMaxWheels})) {
    ObjectReader object = reader.object(element);
    sim::WheelModel& wheel = rover.wheels.emplace_back();
    object.text("name", kRequired, {.most = 8, .is_name = true}, wheel.name);
    read_point(object, "position_m", wheel.position_m);
    read_fields(object, sim::wheel_fields(), kRequired, wheel);
    if (double reckoned_m = 0.0;
        object.number("software_radius_m", kOptional, {"m", 0.01, 2.0}, reckoned_m) && reckoned_m > 0.0)
      wheel.software_radius_m = reckoned_m;
    wheel.grousers = read_grousers(object);
    if (!wheel.grousers) wheel.grousers = everywhere;
    object.boolean("steerable", kRequired, wheel.steerable);
    std::size_t drive = 0;
    if (object.choice("drive", kOptional, kWheelDrives, drive))
      wheel.drive = static_cast<sim::WheelDrive>(drive);
    object.refuse_unknown();
    wheel.side = side_of(wheel);
  }
}

// Of what is between the bodies; each type has the joints it has.
void read_joints(ObjectReader& reader, sim::Suspension& suspension) {
  if (suspension.type == sim::SuspensionType::kRigid) return;
  read_fields(reader, sim::differential_fields(), kRequired, suspension);
  if (suspension.type == sim::SuspensionType::kRockerBogie)
    read_fields(reader, sim::bogie_fields(), kRequired, suspension);
}

void read_suspension(ObjectReader& reader, sim::RoverModel& rover) {
  auto object = reader.object("suspension", kRequired);
  if (!object) return;
  std::size_t type = 0;
  // What other keys there should be depends on the type.
  if (!object->choice("type", kRequired, kSuspensions, type)) return;
  rover.suspension.type = static_cast<sim::SuspensionType>(type);
  if (rover.suspension.type != sim::SuspensionType::kRigid)
    read_point(*object, "rocker_pivot_m", rover.suspension.rocker_pivot_m);
  if (rover.suspension.type == sim::SuspensionType::kRockerBogie) {
    read_point(*object, "bogie_pivot_m", rover.suspension.bogie_pivot_m);
    std::vector<std::string> carried;
    object->texts("bogie_wheels", kRequired, {2, 2}, {.most = 1}, carried);
    for (sim::WheelModel& wheel : rover.wheels) {
      wheel.on_bogie = wheel.name.size() == 2 &&
                       std::find(carried.begin(), carried.end(), wheel.name.substr(1)) != carried.end();
    }
  }
  read_joints(*object, rover.suspension);
  object->refuse_unknown();
}

bool read_motor(ObjectReader& reader, std::string_view key, Presence presence, sim::DriveMotor& drive) {
  auto object = reader.object(key, presence);
  if (!object) return false;
  read_fields(*object, sim::motor_fields(), kRequired, drive);
  object->refuse_unknown();
  return true;
}

void read_masses(ObjectReader& reader, sim::MassDistribution& masses) {
  auto object = reader.object("masses", kOptional);
  if (!object) return;
  read_fields(*object, sim::part_mass_fields(), kRequired, masses);
  std::vector<double> xyz;
  if (object->numbers("body_inertia_kg_m2", kOptional, {3, 3}, {"kg m2", 0.0, 1e5, true}, xyz))
    masses.body_inertia_kg_m2 = Eigen::Vector3d(xyz[0], xyz[1], xyz[2]);
  object->refuse_unknown();
}

// What a campaign does not say of its rover and planning asks for, from what it does say.
void assume_body(sim::RoverModel& rover) {
  double front = 0.0, rear = 0.0, half_width = 0.0;
  for (const sim::WheelModel& wheel : rover.wheels) {
    front = std::max(front, wheel.position_m.x() + wheel.radius_m);
    rear = std::min(rear, wheel.position_m.x() - wheel.radius_m);
    half_width = std::max(half_width, std::abs(wheel.position_m.y()) + 0.5 * wheel.width_m);
  }
  rover.body_length_m = front - rear;
  rover.body_width_m = 2.0 * half_width;
  // The body hangs from its lowest pivot, or rides above the axles.
  const double radius_m = rover.smallest_wheel_radius_m();
  rover.belly_clearance_m = 2.0 * radius_m;
  if (rover.suspension.type == sim::SuspensionType::kRockerBogie)
    rover.belly_clearance_m = rover.suspension.bogie_pivot_m.z();
  if (rover.suspension.type == sim::SuspensionType::kAveraging)
    rover.belly_clearance_m = rover.suspension.rocker_pivot_m.z();
  rover.belly_clearance_m = std::max(rover.belly_clearance_m, radius_m);
  rover.cruise_speed_m_s = std::min(rover.cruise_speed_m_s, radius_m * rover.drive.max_wheel_rate_rad_s);
  rover.turn_rate_rad_s = rover.cruise_speed_m_s / (0.5 * std::hypot(front - rear, 2.0 * half_width));
  rover.min_turn_radius_m = rover.track_m();
}

// Each name that a wheel of a rocker-bogie can't have: without its wheels all that is asked of it would fail.
void check_wheel_names(ObjectReader& reader, const sim::RoverModel& rover) {
  if (rover.suspension.type != sim::SuspensionType::kRockerBogie) return;
  std::vector<std::string> left(kUsualWheels.begin(), kUsualWheels.end());
  if (rover.wheels.size() != left.size()) return;
  for (std::size_t k = 0; k < rover.wheels.size(); ++k) {
    const std::string& name = rover.wheels[k].name;
    if (std::erase(left, name) == 1) continue;
    const bool usual = std::find(kUsualWheels.begin(), kUsualWheels.end(), name) != kUsualWheels.end();
    reader.faults().push_back(
        {fmt::format("{}/wheels/{}/name", reader.pointer(), k),
         fmt::format("name = {} {}", in_quotes(name),
                     usual ? "is another wheel's"
                           : "is no wheel of a rocker_bogie, which has lf, lm, lr, rf, rm, rr")});
  }
}

// A rocker-bogie's wheels are in one order everywhere.
void sort_wheels(sim::RoverModel& rover) {
  if (rover.suspension.type != sim::SuspensionType::kRockerBogie) return;
  const auto place = [&](const sim::WheelModel& wheel) {
    return std::find(kUsualWheels.begin(), kUsualWheels.end(), wheel.name) - kUsualWheels.begin();
  };
  std::stable_sort(rover.wheels.begin(), rover.wheels.end(),
                   [&](const sim::WheelModel& a, const sim::WheelModel& b) { return place(a) < place(b); });
}

void write_point(Writer& w, std::string_view key, const Eigen::Vector3d& p) {
  w.key(key).begin_array().exact(p.x()).exact(p.y()).exact(p.z()).end_array();
}

void write_wheels(Writer& w, const sim::RoverModel& rover) {
  w.key("wheels").begin_array();
  for (const sim::WheelModel& wheel : rover.wheels) {
    w.begin_object().text("name", wheel.name);
    write_point(w, "position_m", wheel.position_m);
    write_fields(w, sim::wheel_fields(), wheel);
    if (wheel.software_radius_m) w.exact("software_radius_m", *wheel.software_radius_m);
    if (wheel.grousers) {
      write_fields(w.key("grousers").begin_object(), sim::grouser_fields(), *wheel.grousers);
      w.end_object();
    }
    w.boolean("steerable", wheel.steerable);
    if (wheel.drive != sim::WheelDrive::kDriven)
      w.text("drive", kWheelDrives[static_cast<std::size_t>(wheel.drive)]);
    w.end_object();
  }
  w.end_array();
  if (rover.wheel_slices > 1) w.exact("wheel_slices", rover.wheel_slices);
}

void write_suspension(Writer& w, const sim::RoverModel& rover) {
  const sim::Suspension& suspension = rover.suspension;
  w.key("suspension").begin_object().text("type", kSuspensions[static_cast<std::size_t>(suspension.type)]);
  if (suspension.type != sim::SuspensionType::kRigid)
    write_point(w, "rocker_pivot_m", suspension.rocker_pivot_m);
  if (suspension.type == sim::SuspensionType::kRockerBogie) {
    write_point(w, "bogie_pivot_m", suspension.bogie_pivot_m);
    std::vector<std::string> on_bogie;
    for (const sim::WheelModel& wheel : rover.wheels)
      if (wheel.on_bogie && wheel.side == sim::Side::kLeft) on_bogie.push_back(wheel.name.substr(1));
    w.texts("bogie_wheels", on_bogie);
  }
  write_fields(w, sim::differential_fields(), suspension);
  write_fields(w, sim::bogie_fields(), suspension);
  w.end_object();
}

void write_masses(Writer& w, const sim::MassDistribution& masses) {
  if (!masses.wheel_kg && !masses.rocker_kg && !masses.bogie_kg && !masses.body_inertia_kg_m2) return;
  w.key("masses").begin_object();
  write_fields(w, sim::part_mass_fields(), masses);
  if (masses.body_inertia_kg_m2) write_point(w, "body_inertia_kg_m2", *masses.body_inertia_kg_m2);
  w.end_object();
}

void write_motor(Writer& w, std::string_view key, const sim::DriveMotor& drive) {
  write_fields(w.key(key).begin_object(), sim::motor_fields(), drive);
  w.end_object();
}

}  // namespace

Result<sim::RoverModel> read_rover_file(std::string_view bytes) {
  const auto document = parse(bytes);
  if (!document) return fail(document.error());
  sim::RoverModel rover;
  std::vector<Fault> faults;
  ObjectReader reader(*document, "", faults);
  std::size_t format = 0;
  reader.choice("format", kRequired, {"rover/1"}, format);
  reader.text("name", kRequired, {.most = 64, .is_name = true}, rover.name);
  reader.text("summary", kRequired, {.most = 500}, rover.summary);
  reader.texts("sources", kRequired, {1, kMaxSources}, {.most = 500}, rover.sources);
  reader.texts("assumed", kRequired, {0, kMaxSources}, {}, rover.assumed);
  read_fields(reader, sim::mass_fields(), kRequired, rover);
  read_point(reader, "com_m", rover.com_m);
  read_masses(reader, rover.masses);
  read_wheels(reader, rover);
  read_suspension(reader, rover);
  read_motor(reader, "drive", kRequired, rover.drive);
  if (sim::DriveMotor steering; read_motor(reader, "steering", kOptional, steering))
    rover.steering = steering;
  if (auto power = reader.object("power", kOptional)) {
    read_fields(*power, sim::power_fields(), kRequired, rover.power.emplace());
    power->refuse_unknown();
  }
  read_fields(reader, sim::closure_fields(), kRequired, rover);
  read_fields(reader, sim::body_fields(), kRequired, rover);
  read_effects(reader, rover.effects);
  reader.refuse_unknown();
  // What holds between the numbers can only be asked of a rover whose numbers were read.
  if (faults.empty()) {
    faults = sim::faults_of(rover);
    for (Fault& fault : sim::faults_of(rover.effects, rover))
      faults.push_back({"/effects" + fault.pointer, fault.message});
    for (Fault& fault : sim::faults_of(rover.effects))
      faults.push_back({"/effects" + fault.pointer, fault.message});
  }
  if (!faults.empty()) return fail(ErrorCode::kUnreadableData, summary_of(faults), faults);
  return rover;
}

sim::RoverModel read_campaign_rover(ObjectReader& reader) {
  sim::RoverModel rover;
  const std::size_t before = reader.faults().size();
  reader.text("name", kRequired, {}, rover.name);
  read_fields(reader, sim::mass_fields(), kRequired, rover);
  read_point(reader, "com_m", rover.com_m);
  read_masses(reader, rover.masses);
  read_wheels(reader, rover);
  read_suspension(reader, rover);
  read_motor(reader, "drive", kRequired, rover.drive);
  if (reader.faults().size() == before) check_wheel_names(reader, rover);
  if (reader.faults().size() == before) {
    sort_wheels(rover);
    assume_body(rover);
  }
  rover.assumed = {"body"};
  read_fields(reader, sim::body_fields(), kOptional, rover);
  reader.refuse_unknown();
  if (reader.faults().size() == before)
    for (const Fault& fault : sim::faults_of(rover))
      reader.faults().push_back({reader.pointer() + fault.pointer, fault.message});
  return rover;
}

void write_rover(Writer& w, const sim::RoverModel& rover) {
  w.begin_object().text("format", "rover/1").text("name", rover.name).text("summary", rover.summary);
  w.texts("sources", rover.sources).texts("assumed", rover.assumed);
  write_fields(w, sim::mass_fields(), rover);
  write_point(w, "com_m", rover.com_m);
  write_masses(w, rover.masses);
  write_wheels(w, rover);
  write_suspension(w, rover);
  write_motor(w, "drive", rover.drive);
  if (rover.steering) write_motor(w, "steering", *rover.steering);
  if (rover.power) {
    write_fields(w.key("power").begin_object(), sim::power_fields(), *rover.power);
    w.end_object();
  }
  write_fields(w, sim::closure_fields(), rover);
  write_fields(w, sim::body_fields(), rover);
  if (!rover.effects.empty()) write_effects(w, rover.effects);
  w.end_object();
}

void write_campaign_rover(Writer& w, const sim::RoverModel& rover) {
  w.begin_object().text("name", rover.name);
  write_fields(w, sim::mass_fields(), rover);
  write_point(w, "com_m", rover.com_m);
  write_wheels(w, rover);
  write_suspension(w, rover);
  write_motor(w, "drive", rover.drive);
  w.end_object();
}

}  // namespace slipway::api::json
