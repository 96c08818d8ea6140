#include "campaign/drive_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string_view>
#include <utility>

#include "campaign/campaign_files.h"
#include "core/angle.h"
#include "sim/effects/effect_catalogue.h"
#include "sim/rover/drive_command.h"

namespace slipway::campaign {
namespace {

// "h090", "h022p5": whole degrees in three digits, so that ids sort as headings do.
std::string heading_name(double heading_rad) {
  double heading_deg = std::fmod(deg_from_rad(heading_rad), 360.0);
  if (heading_deg < 0.0) heading_deg += 360.0;
  // What was degrees in a file is so again.
  heading_deg = std::round(heading_deg * 1e6) / 1e6;
  if (heading_deg >= 360.0) heading_deg -= 360.0;
  const double whole = std::floor(heading_deg);
  std::string name = fmt::format("h{:03.0f}", whole);
  if (heading_deg > whole) {
    // "0.500000" without the zeros at its end; never with an exponent, which would put a minus into the id.
    std::string fraction = fmt::format("{:.6f}", heading_deg - whole);
    fraction.erase(fraction.find_last_not_of('0') + 1);
    name += "p" + fraction.substr(2);
  }
  return name;
}

std::size_t count_of(const DriveTable& table) {
  std::size_t count = 0;
  for (const DriveEntry& entry : table.entries)
    count += entry.terrains.size() * entry.headings_rad.size() * static_cast<std::size_t>(entry.repeats);
  return count;
}

void check_entry(const DriveTable& table, std::size_t k, std::vector<Fault>& faults) {
  const DriveEntry& entry = table.entries[k];
  const std::string pointer = fmt::format("/drives/{}", k);
  for (const std::size_t t : entry.terrains) {
    const TableTerrain& terrain = table.terrains[t];
    if (!terrain.ground->surface(entry.x_m, entry.y_m)) {
      faults.push_back({pointer + "/start", fmt::format("start ({:g}, {:g}) m is not on terrain {}",
                                                        entry.x_m, entry.y_m, terrain.name)});
    }
  }
  for (std::size_t i = 0; i < entry.legs.size(); ++i)
    if (auto why = sim::why_no_crab(*table.rover, entry.legs[i].command.crab_rad))
      faults.push_back({fmt::format("{}/legs/{}/crab_deg", pointer, i), std::move(*why)});
  for (const auto& [wheel, failure] : entry.failed_wheels) {
    const auto& wheels = table.rover->wheels;
    if (std::any_of(wheels.begin(), wheels.end(),
                    [&wheel = wheel](const auto& w) { return w.name == wheel; }))
      continue;
    std::vector<std::string_view> names;
    for (const sim::WheelModel& known : wheels) names.push_back(known.name);
    faults.push_back(
        {fmt::format("{}/failed_wheels/{}", pointer, wheel),
         fmt::format("{} has no wheel {}, it has {}", table.rover->name, wheel, fmt::join(names, ", "))});
  }
}

void check_effects(const DriveTable& table, std::vector<Fault>& faults) {
  std::vector<Fault> of_effects = sim::faults_of(table.effects);
  if (of_effects.empty()) of_effects = sim::faults_of(table.effects, *table.rover);
  for (Fault& fault : of_effects) faults.push_back({"/effects" + fault.pointer, std::move(fault.message)});
  if (!of_effects.empty()) return;
  // Soils are drawn by their names: a place has none of its own.
  for (std::size_t i = 0; i < table.effects.size(); ++i) {
    const sim::Effect* const effect = sim::find_effect(table.effects[i].name);
    if (effect->region == nullptr || !table.effects[i].on) continue;
    faults.push_back({fmt::format("/effects/{}/name", i),
                      fmt::format("{} is at work in a region of the map, which a campaign "
                                  "can't have: give its terrain a soil map",
                                  effect->name)});
  }
}

// A recorded campaign describes its soils by Bekker's law and Janosi and Hanamoto's, and its drives are
// simulated.
void check_soils(const DriveTable& table, std::vector<Fault>& faults) {
  for (std::size_t t = 0; t < table.terrains.size(); ++t)
    for (const std::string& name : soils_of(table.terrains[t])) {
      const auto soil = table.soils.find(name);
      if (soil == table.soils.end()) continue;
      const sim::Soil& mean = soil->second.mean;
      if (mean.has_bekker_law() && mean.shear_law.row == nullptr) continue;
      faults.push_back(
          {fmt::format("/terrains/{}/soil", t),
           fmt::format("soil {} has {}, a drive table's soils have Bekker's law and Janosi and Hanamoto's",
                       name, mean.slip_curve ? "a slip curve" : "laws of its own choice")});
    }
}

}  // namespace

std::vector<TableDrive> expand(const DriveTable& table) {
  std::vector<TableDrive> drives;
  drives.reserve(count_of(table));
  for (std::size_t k = 0; k < table.entries.size(); ++k) {
    const DriveEntry& entry = table.entries[k];
    for (const std::size_t terrain : entry.terrains) {
      for (const double heading_rad : entry.headings_rad) {
        std::string id = entry.id;
        if (entry.terrains.size() > 1) id += "-" + table.terrains[terrain].name;
        if (entry.headings_rad.size() > 1) id += "-" + heading_name(heading_rad);
        const std::string first = entry.repeats > 1 ? id + "-r1" : id;
        for (int repeat = 1; repeat <= entry.repeats; ++repeat) {
          drives.push_back({.id = entry.repeats > 1 ? fmt::format("{}-r{}", id, repeat) : id,
                            .entry = k,
                            .terrain = terrain,
                            .start = {entry.x_m, entry.y_m, heading_rad},
                            .repeat_of = repeat > 1 ? first : ""});
        }
      }
    }
  }
  return drives;
}

std::vector<Fault> faults_of(const DriveTable& table) {
  std::vector<Fault> faults;
  check_effects(table, faults);
  check_soils(table, faults);
  for (std::size_t k = 0; k < table.entries.size(); ++k) check_entry(table, k, faults);
  if (const std::size_t count = count_of(table); count > kMaxDrives) {
    faults.push_back(
        {"/drives", fmt::format("drives make {} drives, must be at most {}", count, kMaxDrives)});
    return faults;
  }
  std::set<std::string> ids, reported;
  const std::vector<TableDrive> drives = expand(table);
  for (const TableDrive& drive : drives) {
    if (ids.insert(drive.id).second || !reported.insert(drive.id).second) continue;
    faults.push_back(
        {fmt::format("/drives/{}/id", drive.entry),
         fmt::format("drive {} is given twice: an id, a terrain or a heading is repeated", drive.id)});
  }
  // Drives of one id collide in every file: said once, above.
  if (reported.empty())
    for (Fault& fault : colliding_files(table, drives)) faults.push_back(std::move(fault));
  return faults;
}

std::vector<std::string> soils_of(const TableTerrain& terrain) {
  std::vector<std::string> names = terrain.soil_map ? terrain.soil_map->soils() : std::vector<std::string>{};
  names.push_back(terrain.soil);
  return names;
}

std::int16_t class_elsewhere(const TableTerrain& terrain) {
  std::set<int> classes;
  for (const dem::SoilClass& row : terrain.soil_map->legend()) classes.insert(row.value);
  std::int16_t free = 0;
  while (classes.contains(free)) ++free;
  return free;
}

std::optional<double> motor_temp_c(const DriveTable& table, const DriveEntry& entry) {
  return entry.motor_temp_c ? entry.motor_temp_c : table.options.motor_temp_c;
}

sim::RoverModel driven_rover(const DriveTable& table, const DriveEntry& entry) {
  sim::RoverModel rover = *table.rover;
  rover.drive.currents_by_format = true;
  sim::apply_effects(sim::in_force(table.rover->effects, table.effects), rover);
  sim::fail_wheels(rover, entry.failed_wheels, {.motor_temp_c = motor_temp_c(table, entry)});
  return rover;
}

}  // namespace slipway::campaign
