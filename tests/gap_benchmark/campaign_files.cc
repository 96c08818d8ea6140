#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "sealed_campaign.h"
#include "sensor_errors.h"

namespace slipway::gap_benchmark {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

double rounded(double value, int digits) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return std::strtod(text.data(), nullptr);
}

Json soil_json(const TrueSoil& soil) {
  return {{"k_c", soil.k_c},
          {"k_phi", soil.k_phi},
          {"n", soil.n},
          {"cohesion_pa", soil.cohesion_pa},
          {"friction_angle_deg", rounded(soil.friction_rad * kDegPerRad, 6)},
          {"shear_modulus_x_m", soil.shear_modulus_m},
          {"density_kg_m3", soil.density_kg_m3},
          {"n1", 0.0},
          {"c1", rounded(soil.c1, 6)},
          {"c2", rounded(soil.c2, 6)}};
}

Json rover_json(const RoverOnFile& rover) {
  Json wheels = Json::array();
  for (std::size_t k = 0; k < kWheels; ++k)
    wheels.push_back({{"name", kWheelNames[k]},
                      {"position_m", {rover.wheel_m[k].x(), rover.wheel_m[k].y(), rover.radius_m}},
                      {"radius_m", rover.radius_m},
                      {"width_m", rover.width_m},
                      {"steerable", k % 3 != 1}});
  const auto point = [](const Eigen::Vector3d& p) { return Json{p.x(), p.y(), p.z()}; };
  return {{"name", "mer-class"},
          {"mass_kg", rover.mass_kg},
          {"com_m", point(rover.com_m)},
          {"wheels", std::move(wheels)},
          {"suspension",
           {{"type", "rocker_bogie"},
            {"rocker_pivot_m", point(rover.rocker_pivot_m)},
            {"bogie_pivot_m", point(rover.bogie_pivot_m)},
            {"bogie_wheels", {"m", "r"}}}},
          {"drive",
           {{"torque_constant_nm_per_a", rover.torque_constant_nm_a},
            {"gear_ratio", rover.gear_ratio},
            {"gear_efficiency", rover.gear_efficiency},
            {"no_load_current_a", rover.no_load_a},
            {"max_wheel_rate_deg_s", 25.0},
            {"bus_voltage_v", 28.0}}}};
}

// What was measured apart from the drives, one standard deviation each; null where nothing was.
Json parameter_std(const CampaignCase& made_of) {
  Json std;
  if (made_of.nominal == NominalSoil::kMeasured)
    std = {{"stiffness", 0.03}, {"n", 0.01}, {"cohesion", 0.03}, {"friction", 0.01}, {"shear_modulus", 0.03}};
  if (made_of.measured_closures)
    for (const auto& [name, value] :
         {std::pair{"lateral_shear_modulus", 0.03}, std::pair{"c1", 0.01}, std::pair{"c2", 0.02},
          std::pair{"exit_angle", 0.02}, std::pair{"shear_coupling", 0.05}})
      std[name] = value;
  return std;
}

Json campaign_json(const SealedCampaign& campaign, const std::string& name) {
  Json terrains = Json::object();
  for (const NamedTerrain& terrain : campaign.terrains)
    terrains[terrain.name] = {{"dem", terrain.name + ".tif"}, {"soil", "nominal"}};
  Json drives = Json::array();
  for (const MadeDrive& drive : campaign.drives) {
    const DriveOrder& order = drive.order;
    drives.push_back({{"id", order.id},
                      {"file", order.id + ".csv"},
                      {"terrain", order.terrain},
                      {"commanded",
                       {{"speed_m_s", order.speed_m_s},
                        {"curvature_1_m", order.curvature_1_m},
                        {"turn_in_place", order.turn_in_place},
                        {"duration_s", order.duration_s}}}});
  }
  Json file{{"format", "drive-campaign/1"},
            {"name", name},
            {"gravity_m_s2", campaign.world.gravity_m_s2},
            {"rover", rover_json(campaign.world.rover)},
            {"soils", {{"nominal", soil_json(campaign.nominal)}}},
            {"terrains", std::move(terrains)},
            {"measurement_std",
             {{"position_m", kPositionStd_m},
              {"attitude_deg", kAttitudeStd_deg},
              {"current_rel", kCurrentRel},
              {"current_a", kCurrentStd_a},
              {"sinkage_m", kSinkageStd_m}}},
            {"drives", std::move(drives)}};
  if (Json std = parameter_std(campaign.made_of); !std.is_null()) file["parameter_std"] = std::move(std);
  return file;
}

class CsvLine {
 public:
  explicit CsvLine(std::string& out) : out_(out) {}
  void number(double value) {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.7g", value);
    cell(text.data());
  }
  void cell(const char* text) {
    if (!first_) out_ += ',';
    first_ = false;
    out_ += text;
  }
  void end() {
    out_ += '\n';
    first_ = true;
  }

 private:
  std::string& out_;
  bool first_ = true;
};

std::string drive_csv(const SealedCampaign& campaign, const MadeDrive& drive, RandomStream& random) {
  const CampaignCase& made_of = campaign.made_of;
  const double noise = made_of.even_soil ? 0.0 : 1.0;
  std::string out = "t_s,x_m,y_m,z_m,roll_deg,pitch_deg,yaw_deg";
  for (const char* wheel : kWheelNames) {
    const std::string name = wheel;
    out += "," + name + "_rate_deg_s," + name + "_steer_deg," + name + "_current_a";
    if (made_of.sinkage) out += "," + name + "_sinkage_m";
    if (made_of.temperature) out += "," + name + "_motor_temp_c";
  }
  out += ",bus_voltage_v\n";
  CsvLine line(out);
  for (const DriveRow& row : drive.rows) {
    line.number(row.time_s);
    for (const double place : {row.x_m, row.y_m, row.z_m})
      line.number(place + noise * kPositionStd_m * random.normal());
    for (const double angle : {row.roll_rad, row.pitch_rad, row.yaw_rad})
      line.number(angle * kDegPerRad + noise * kAttitudeStd_deg * random.normal());
    for (const WheelRow& wheel : row.wheels) {
      line.number(wheel.rate_rad_s * kDegPerRad);
      line.number(wheel.steer_rad * kDegPerRad);
      const double deviation = std::hypot(kCurrentRel * wheel.current_a, kCurrentStd_a);
      line.number(wheel.current_a + noise * deviation * random.normal());
      const double sinkage = std::max(wheel.sinkage_m + noise * kSinkageStd_m * random.normal(), 0.0);
      if (made_of.sinkage) {
        if (row.surveyed)
          line.number(sinkage);
        else
          line.cell("");
      }
      if (made_of.temperature) line.number(row.motor_temp_c);
    }
    line.number(28.0);
    line.end();
  }
  return out;
}

std::string written(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  return out ? "" : file.string() + " can't be written";
}

}  // namespace

std::string write_campaign(const SealedCampaign& campaign, const std::string& name,
                           const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  std::string fault = written(folder / "campaign.json", campaign_json(campaign, name).dump(1) + "\n");
  for (const NamedTerrain& terrain : campaign.terrains)
    if (fault.empty() && !write_geotiff(terrain.grid, folder / (terrain.name + ".tif")))
      fault = (folder / terrain.name).string() + ".tif can't be written";
  RandomStream random(campaign.noise_seed);
  for (const MadeDrive& drive : campaign.drives)
    if (fault.empty())
      fault = written(folder / (drive.order.id + ".csv"), drive_csv(campaign, drive, random));
  return fault;
}

std::string answer_of(const SealedCampaign& campaign) {
  const CampaignCase& made_of = campaign.made_of;
  const char* nominal = made_of.nominal == NominalSoil::kTrue ? "true"
                        : made_of.nominal == NominalSoil::kNear || made_of.nominal == NominalSoil::kMeasured
                            ? "near"
                        : made_of.nominal == NominalSoil::kFar ? "far"
                                                               : "usual";
  Json effects = Json::object();
  for (const auto& [name, parameters] : campaign.effects) effects[name] = parameters;
  Json answer{{"soil", campaign.world.soil.name},
              {"kind", made_of.on_hills ? "hills" : "tilt"},
              {"effects", std::move(effects)},
              {"fidelity", name_of(made_of.fidelity)},
              {"size", made_of.size},
              {"nominal", nominal},
              {"truth_soil", soil_json(campaign.world.soil)}};
  if (campaign.world.hidden.patch_weakening > 0.0)
    answer["place"] = {{"x_m", campaign.world.hidden.patch_x_m},
                       {"y_m", campaign.world.hidden.patch_y_m},
                       {"radius_m", campaign.world.hidden.patch_radius_m}};
  return answer.dump();
}

}  // namespace slipway::gap_benchmark
