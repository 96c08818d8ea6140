#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "api/files/campaign/drive_campaign_source.h"
#include "small_world.h"

namespace slipway::api::testing {

// A small campaign of two drives.
inline const std::string kDocument = R"({
 "format": "drive-campaign/1", "name": "small", "gravity_m_s2": 3.71,
 "rover": {"name": "Four Wheels", "mass_kg": 60, "com_m": [0, 0, 0.3],
  "wheels": [
   {"name": "lf", "position_m": [0.4, 0.3, 0.1], "radius_m": 0.1, "width_m": 0.1, "steerable": true},
   {"name": "lr", "position_m": [-0.4, 0.3, 0.1], "radius_m": 0.1, "width_m": 0.1, "steerable": true},
   {"name": "rf", "position_m": [0.4, -0.3, 0.1], "radius_m": 0.1, "width_m": 0.1, "steerable": true},
   {"name": "rr", "position_m": [-0.4, -0.3, 0.1], "radius_m": 0.1, "width_m": 0.1, "steerable": true}],
  "suspension": {"type": "averaging", "rocker_pivot_m": [0, 0.25, 0.3]},
  "drive": {"torque_constant_nm_per_a": 0.02, "gear_ratio": 1000, "gear_efficiency": 0.6,
            "no_load_current_a": 0.05, "max_wheel_rate_deg_s": 60, "bus_voltage_v": 28}},
 "soils": {"sand": {"k_c": 1000, "k_phi": 900000, "n": 1, "cohesion_pa": 500, "friction_angle_deg": 33,
                    "shear_modulus_x_m": 0.02}},
 "terrains": {"level": {"dem": "level.tif", "soil": "sand"}},
 "measurement_std": {"position_m": 0.01, "attitude_deg": 0.2, "current_rel": 0.02, "current_a": 0.01,
                     "sinkage_m": 0.002},
 "drives": [
  {"id": "a", "file": "a.csv", "terrain": "level",
   "commanded": {"speed_m_s": -0.05, "curvature_1_m": 0.2, "turn_in_place": false, "duration_s": 4}},
  {"id": "b", "file": "b.csv", "terrain": "level", "repeat_of": "a",
   "commanded": {"speed_m_s": -0.05, "curvature_1_m": 0, "turn_in_place": true, "duration_s": 4}}]})";

inline const std::string kHeader = "t_s,x_m,y_m,z_m,lf_current_a,sky\n";
inline const std::string kRows = "0,1,2,0.5,0.25,blue\n2,1.1,2,0.5,,\n";

class DriveCampaignFolder : public ::testing::Test {
 protected:
  DriveCampaignFolder() {
    write("campaign.json", kDocument);
    write("a.csv", kHeader + kRows);
    write("b.csv", "t_s\n0\n1\n");
    std::filesystem::copy_file(std::filesystem::path(SLIPWAY_DATA_FOLDER) / "gap-practice/p01/tilt_00.tif",
                               path() / "level.tif");
  }
  const std::filesystem::path& path() const { return folder_.path(); }
  void write(const std::string& file, const std::string& bytes) const { write_file(path() / file, bytes); }
  // The document with `before`, which it holds once, made into `after`.
  void edit(const std::string& before, const std::string& after) const {
    std::string text = kDocument;
    const std::size_t at = text.find(before);
    ASSERT_NE(at, std::string::npos) << before;
    write("campaign.json", text.replace(at, before.size(), after));
  }
  Result<gap::DriveCampaign> load() const { return load_drive_campaign(path(), Catalogue{}); }
  // Some fault is at the pointer and has the words in it.
  void expect_fault(const std::string& pointer, const std::string& words) const {
    const auto campaign = load();
    ASSERT_FALSE(campaign) << "loads, in spite of: " << words;
    const auto& faults = campaign.error().faults;
    const bool told = std::any_of(faults.begin(), faults.end(), [&](const Fault& fault) {
      return fault.pointer == pointer && fault.message.find(words) != std::string::npos;
    });
    std::string all;
    for (const Fault& fault : faults) all += "\n  " + fault.pointer + "  " + fault.message;
    EXPECT_TRUE(told) << pointer << "  " << words << "\nis not among:" << all;
  }
  void expect_csv_fault(const std::string& bytes, const std::string& pointer,
                        const std::string& words) const {
    write("a.csv", bytes);
    expect_fault("a.csv#" + pointer, words);
  }

  ScratchFolder folder_;
};

}  // namespace slipway::api::testing
