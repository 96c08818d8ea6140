#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "api/files/drive_table/drive_table_file.h"
#include "api/files/failed_wheels.h"
#include "api/json/faults.h"
#include "core/angle.h"

namespace slipway::api::json {
namespace {

constexpr std::size_t kMaxEntries = 5000;
constexpr std::size_t kMaxLegs = 100;
constexpr int kMaxRepeats = 1000;

void read_turn(ObjectReader& reader, const sim::RoverModel& rover, sim::DriveLeg& leg) {
  double turn_rad = 0.0;
  double rate_rad_s = rover.turn_rate_rad_s;
  leg.command.turn_in_place = true;
  reader.angle_deg("turn_deg", kRequired, {"deg", -3600.0, 3600.0}, turn_rad);
  reader.angle_deg("turn_rate_deg_s", kOptional, {"deg/s", 1e-3, 100.0}, rate_rad_s);
  if (turn_rad == 0.0) reader.fault("turn_deg", "turn_deg = 0 deg, must turn somewhere");
  leg.turn_rad = std::abs(turn_rad);
  leg.command.turn_rate_rad_s = std::copysign(rate_rad_s, turn_rad);
}

// Speed, curvature and crab keep the signs of a drive campaign's commands.
void read_way(ObjectReader& reader, const sim::RoverModel& rover, sim::DriveLeg& leg) {
  double speed_m_s = rover.cruise_speed_m_s;
  bool backwards = false;
  reader.number("length_m", kRequired, {"m", 0.0, 10'000.0, true}, leg.length_m);
  reader.number("speed_m_s", kOptional, {"m/s", 1e-4, 5.0}, speed_m_s);
  reader.boolean("backwards", kOptional, backwards);
  reader.number("curvature_1_m", kOptional, {"1/m", -10.0, 10.0}, leg.command.curvature_1_m);
  reader.angle_deg("crab_deg", kOptional, {"deg", -90.0, 90.0}, leg.command.crab_rad);
  leg.command.speed_m_s = backwards ? -speed_m_s : speed_m_s;
}

std::vector<sim::DriveLeg> read_legs(ObjectReader& entry, const sim::RoverModel& rover) {
  std::vector<sim::DriveLeg> legs;
  for (const Element& element : entry.list("legs", kRequired, {1, kMaxLegs})) {
    ObjectReader reader(*element.value, element.pointer, entry.faults());
    if (!reader.is_object()) continue;
    sim::DriveLeg& leg = legs.emplace_back();
    if (element.value->find("turn_deg") != nullptr) {
      read_turn(reader, rover, leg);
    } else {
      read_way(reader, rover, leg);
    }
    reader.refuse_unknown();
  }
  return legs;
}

// By name; all of the table's where none is named.
void read_terrains(ObjectReader& entry, const std::vector<campaign::TableTerrain>& terrains,
                   std::vector<std::size_t>& out) {
  std::vector<std::string> names, known;
  for (const campaign::TableTerrain& terrain : terrains) known.push_back(terrain.name);
  if (!entry.texts("terrains", kOptional, {1, 200}, {.most = 64}, names)) {
    for (std::size_t t = 0; t < terrains.size(); ++t) out.push_back(t);
    return;
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::size_t t = 0;
    while (t < known.size() && known[t] != names[i]) ++t;
    if (t < known.size()) {
      out.push_back(t);
    } else {
      entry.faults().push_back({child_pointer(child_pointer(entry.pointer(), "terrains"), i),
                                unknown_name("terrain", names[i], known)});
    }
  }
}

void read_start(ObjectReader& entry, campaign::DriveEntry& out) {
  if (auto start = entry.object("start", kOptional)) {
    start->number("x_m", kRequired, {"m", -1e8, 1e8}, out.x_m);
    start->number("y_m", kRequired, {"m", -1e8, 1e8}, out.y_m);
    start->refuse_unknown();
  }
  std::vector<double> headings_deg;
  if (!entry.numbers("headings_deg", kOptional, {1, 360}, {"deg", -360.0, 360.0}, headings_deg)) return;
  out.headings_rad.clear();
  for (const double heading_deg : headings_deg) out.headings_rad.push_back(rad_from_deg(heading_deg));
}

}  // namespace

std::vector<campaign::DriveEntry> read_table_drives(ObjectReader& table,
                                                    const std::vector<campaign::TableTerrain>& terrains,
                                                    const sim::RoverModel& rover) {
  std::vector<campaign::DriveEntry> entries;
  for (const Element& element : table.list("drives", kRequired, {1, kMaxEntries})) {
    ObjectReader reader(*element.value, element.pointer, table.faults());
    campaign::DriveEntry& entry = entries.emplace_back();
    reader.text("id", kRequired, {.most = 64, .is_name = true}, entry.id);
    read_terrains(reader, terrains, entry.terrains);
    read_start(reader, entry);
    entry.legs = read_legs(reader, rover);
    reader.whole("repeats", kOptional, 1, kMaxRepeats, entry.repeats);
    read_failed_wheels(reader, entry.failed_wheels);
    reader.number("motor_temp_c", kOptional, {"degC", -150.0, 150.0}, entry.motor_temp_c);
    reader.boolean("final_only", kOptional, entry.final_only);
    reader.boolean("plot", kOptional, entry.plot);
    reader.boolean("deformed_terrain", kOptional, entry.deformed_terrain);
    reader.refuse_unknown();
  }
  return entries;
}

}  // namespace slipway::api::json
