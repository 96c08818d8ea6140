#include "api/files/drive_table/campaign_documents.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "api/files/rover_file.h"
#include "core/angle.h"

namespace slipway::api::json {
namespace {

// A channel without an error is as exact as its column is printed.
constexpr double kPrinted = 1e-6;

double std_of(const sim::SensorError& error) {
  return std::max(std::hypot(error.noise, error.bias_std), kPrinted);
}

void write_nominal_soil(Writer& w, const sim::Soil& soil) {
  w.begin_object().exact("k_c", soil.pressure.k_c).exact("k_phi", soil.pressure.k_phi);
  w.exact("n", soil.pressure.n).exact("cohesion_pa", soil.cohesion_pa);
  w.angle_deg("friction_angle_deg", soil.friction_angle_rad);
  w.exact("shear_modulus_x_m", soil.shear_modulus_x_m).exact("shear_modulus_y_m", soil.shear_modulus_y_m);
  w.exact("density_kg_m3", soil.density_kg_m3).exact("c1", soil.c1).exact("c2", soil.c2);
  w.exact("n1", soil.n1).end_object();
}

// Only what its raster holds: cells of classes without a soil are of the class elsewhere.
void write_soil_classes(Writer& w, const campaign::TableTerrain& terrain) {
  w.begin_object().text("raster", terrain.name + "-soil.tif").key("classes").begin_object();
  for (const dem::SoilClass& row : terrain.soil_map->legend())
    if (row.soil) w.text(std::to_string(row.value), *row.soil);
  w.text(std::to_string(campaign::class_elsewhere(terrain)), terrain.soil);
  w.end_object().end_object();
}

void write_grounds(Writer& w, const campaign::DriveTable& table, const std::set<std::size_t>& used) {
  std::set<std::string> soils;
  for (const std::size_t t : used)
    for (const std::string& name : campaign::soils_of(table.terrains[t])) soils.insert(name);
  w.key("soils").begin_object();
  for (const std::string& name : soils) write_nominal_soil(w.key(name), table.soils.find(name)->second.mean);
  w.end_object().key("terrains").begin_object();
  for (const std::size_t t : used) {
    const campaign::TableTerrain& terrain = table.terrains[t];
    w.key(terrain.name).begin_object().text("dem", terrain.name + ".tif");
    if (terrain.soil_map) {
      write_soil_classes(w.key("soil"), terrain);
    } else {
      w.text("soil", terrain.soil);
    }
    w.end_object();
  }
  w.end_object();
}

void write_measurement_std(Writer& w, const sim::DriveSensors& sensors) {
  w.key("measurement_std").begin_object().exact("position_m", std_of(sensors.position_m));
  w.exact("attitude_deg", std::max(deg_from_rad(std_of(sensors.attitude_rad)), kPrinted));
  w.exact("current_rel", sensors.current_a.relative_noise).exact("current_a", std_of(sensors.current_a));
  w.exact("sinkage_m", std_of(sensors.sinkage_m)).end_object();
}

void write_command(Writer& w, const sim::DriveLeg& leg) {
  const sim::DriveCommand& command = leg.command;
  w.key("commanded").begin_object();
  w.exact("speed_m_s", command.turn_in_place ? 0.0 : command.speed_m_s);
  w.exact("curvature_1_m", command.turn_in_place ? 0.0 : command.curvature_1_m);
  w.boolean("turn_in_place", command.turn_in_place);
  // What the format has no key for is only there where it is said.
  if (command.turn_in_place) w.angle_deg("turn_rate_deg_s", command.turn_rate_rad_s);
  if (command.crab_rad != 0.0) w.angle_deg("crab_deg", command.crab_rad);
  w.exact("duration_s", sim::commanded_duration_s(leg)).end_object();
}

// "" for the only leg, "-leg2" for the second of several: also in their files' names.
std::string leg_suffix(std::size_t legs, std::size_t leg) {
  return legs > 1 ? fmt::format("-leg{}", leg + 1) : "";
}

void write_drive(Writer& w, const campaign::DriveTable& table, const campaign::TableDrive& drive,
                 const campaign::DriveRecord& record) {
  const campaign::DriveEntry& entry = table.entries[drive.entry];
  for (std::size_t leg = 0; leg < entry.legs.size(); ++leg) {
    const std::string suffix = leg_suffix(entry.legs.size(), leg);
    const std::string file = drive.id + suffix + ".csv";
    // A leg that was never begun has no file.
    if (std::find(record.files.begin(), record.files.end(), file) == record.files.end()) continue;
    w.begin_object().text("id", drive.id + suffix).text("file", file);
    w.text("terrain", table.terrains[drive.terrain].name);
    write_command(w, entry.legs[leg]);
    if (!drive.repeat_of.empty()) w.text("repeat_of", drive.repeat_of + suffix);
    if (entry.final_only) w.boolean("final_only", true);
    w.end_object();
  }
}

void write_band(Writer& w, std::string_view key, const std::optional<campaign::Band>& band, double unit) {
  if (!band) return;
  w.key(key).begin_object().whole("count", band->count).significant("lowest", unit * band->lowest);
  w.significant("p05", unit * band->p05).significant("p50", unit * band->p50);
  w.significant("p95", unit * band->p95).significant("highest", unit * band->highest).end_object();
}

}  // namespace

std::string campaign_document(const campaign::DriveTable& table, std::span<const campaign::TableDrive> drives,
                              const std::map<std::string, campaign::DriveRecord>& records) {
  std::set<std::size_t> used;
  for (const campaign::TableDrive& drive : drives) {
    const auto record = records.find(drive.id);
    if (record != records.end() && record->second.answered) used.insert(drive.terrain);
  }
  Writer w;
  w.begin_object().text("format", "drive-campaign/1").text("name", table.name);
  w.exact("gravity_m_s2", table.gravity_m_s2);
  write_campaign_rover(w.key("rover"), *table.rover);
  write_grounds(w, table, used);
  write_measurement_std(w, table.sensors);
  w.key("drives").begin_array();
  for (const campaign::TableDrive& drive : drives) {
    const auto record = records.find(drive.id);
    if (record != records.end() && record->second.answered) write_drive(w, table, drive, record->second);
  }
  w.end_array().end_object();
  return w.take() + "\n";
}

std::string campaign_summary_document(const campaign::DriveTable& table, std::size_t drives,
                                      std::span<const campaign::TerrainSummary> summaries) {
  constexpr double kDegPerRad = deg_from_rad(1.0);
  int done = 0;
  for (const campaign::TerrainSummary& summary : summaries) done += summary.drives;
  Writer w;
  w.begin_object().text("format", "campaign-summary/1").text("name", table.name);
  w.whole("drives", static_cast<std::int64_t>(drives)).whole("done", done);
  w.key("terrains").begin_array();
  for (const campaign::TerrainSummary& summary : summaries) {
    w.begin_object().text("terrain", summary.terrain).whole("drives", summary.drives);
    w.key("ends").begin_object();
    for (const auto& [end, count] : summary.ends) w.whole(end, count);
    w.end_object();
    write_band(w, "final_slip_ratio", summary.slip_ratio, 1.0);
    write_band(w, "heading_error_deg", summary.heading_error_rad, kDegPerRad);
    write_band(w, "position_error_m", summary.position_error_m, 1.0);
    write_band(w, "turn_error_deg", summary.turn_error_rad, kDegPerRad);
    write_band(w, "repeat_spread_m", summary.repeat_spread_m, 1.0);
    write_band(w, "repeat_spread_deg", summary.repeat_spread_rad, kDegPerRad);
    w.end_object();
  }
  w.end_array().end_object();
  return w.take() + "\n";
}

}  // namespace slipway::api::json
