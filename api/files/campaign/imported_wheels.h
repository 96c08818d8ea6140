#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/files/campaign/drive_import.h"
#include "gap/diagnosis/model/drive_campaign.h"
#include "sim/rover/drive_command.h"

namespace slipway::api {

// How the columns of wheels end.
inline constexpr std::string_view kRateColumn = "_rate_deg_s", kSteerColumn = "_steer_deg",
                                  kCurrentColumn = "_current_a";
// A share of what is commanded below which a reading is of the other sense.
inline constexpr double kOtherSense = -0.3;

// What the wheels of a drive did in the middle of its rows, and what they were told.
struct DriveOfWheels {
  std::vector<sim::WheelCommand> told, told_otherwise;  // and with the turn to the other side
  std::vector<double> rate_rad_s, steer_rad;            // NaN where they were not recorded
  bool turns = false, in_place = false;
  double yaw_share = gap::kNotMeasured;  // of the commanded change of heading
};

// The median of those that are finite; nothing where none is.
std::optional<double> median_of(std::vector<double> values);
// The rates over the greatest of them: units cancel.
std::vector<double> relative(std::vector<double> rates);
std::vector<double> rates_of(const std::vector<sim::WheelCommand>& told);

// The wheels of an imported campaign: what they did, and where their columns are from.
class ImportedWheels {
 public:
  ImportedWheels(const ImportedCampaign& campaign, const gap::DriveCampaign& read);

  const ImportedCampaign& campaign() const { return campaign_; }
  const sim::RoverModel& rover() const { return rover_; }
  std::size_t count() const { return rover_.wheels.size(); }
  const std::vector<DriveOfWheels>& drives() const { return drives_; }
  // Takes the rates of these wheels as those of the other sense.
  void turn_rates(const std::vector<std::size_t>& wheels);

  std::string names_of(const std::vector<std::size_t>& wheels) const;
  const ImportedColumn* column_of(std::size_t wheel, std::string_view ending) const;
  std::string sources(const std::vector<std::size_t>& wheels, std::string_view ending) const;
  // How the mapping turns these wheels' columns: by `sign` where all wheels are meant, else by `turned`.
  std::string remedy(const std::vector<std::size_t>& wheels, std::string_view ending) const;

 private:
  void leave_out_steering_in_another_unit();

  const ImportedCampaign& campaign_;
  const sim::RoverModel& rover_;
  std::vector<DriveOfWheels> drives_;
};

// "columns.\"{w}_current_a\" of yard.toml"
std::string key_words(const ImportedCampaign& campaign, std::string_view key);
// "mA_FL, mA_FR (unit A)": what the columns of a key are read from.
std::string sources_of(const ImportedCampaign& campaign, std::string_view key);

}  // namespace slipway::api
