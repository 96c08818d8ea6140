#include "api/files/campaign/import_plausibility.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "api/files/campaign/import_attitude.h"
#include "api/files/campaign/import_faults.h"
#include "api/files/campaign/import_unit_checks.h"
#include "api/files/campaign/import_wheel_checks.h"
#include "api/files/campaign/imported_wheels.h"
#include "core/angle.h"
#include "core/pose.h"
#include "core/quantile.h"
#include "gap/diagnosis/model/reading_plausibility.h"
#include "sim/rover/drive_command.h"

namespace slipway::api {
namespace {

using gap::DriveCampaign;
using gap::DriveSample;
using gap::MeasuredDriveSeries;
using gap::ReadingLimit;

const ReadingLimit* limit_of(const std::vector<ReadingLimit>& limits, std::string_view column) {
  const auto at = std::find_if(limits.begin(), limits.end(),
                               [&](const ReadingLimit& limit) { return column.ends_with(limit.column); });
  return at == limits.end() ? nullptr : &*at;
}

class Judge {
 public:
  Judge(const ImportedCampaign& campaign, const DriveCampaign& read) : campaign_(campaign), read_(read) {}

  std::vector<std::string> warnings() {
    judge_tilts();
    judge_sign_of("pitch_deg", &Attitude::pitch_rad);
    judge_sign_of("roll_deg", &Attitude::roll_rad);
    judge_headings();
    return std::move(warnings_);
  }

 private:
  // Recorded tilts beside those of the ground under the recorded positions.
  void judge_tilts() {
    constexpr std::size_t kEvery = 10;  // rows: more say no more
    constexpr double kLevel_deg = 3.0;  // ground below this says nothing of a unit
    constexpr double kFlat = 0.2, kBeyond_deg = 25.0;
    std::vector<double> recorded, of_ground;
    for (const MeasuredDriveSeries& drive : read_.drives)
      for (std::size_t i = 0; i < drive.samples.size(); i += kEvery) {
        const DriveSample& sample = drive.samples[i];
        const double cosine = std::cos(sample.attitude.roll_rad) * std::cos(sample.attitude.pitch_rad);
        const auto point = ground_under(drive, sample);
        if (!point || !std::isfinite(cosine)) continue;
        recorded.push_back(deg_from_rad(std::acos(std::clamp(cosine, -1.0, 1.0))));
        of_ground.push_back(deg_from_rad(std::acos(std::clamp(point->normal.z(), -1.0, 1.0))));
      }
    const auto read = median_of(std::move(recorded)), there = median_of(std::move(of_ground));
    if (!read || !there) return;
    const bool flat = *there > kLevel_deg && *read < kFlat * *there;
    if (!flat && *read < *there + kBeyond_deg) return;
    const ImportedColumn* const roll = column_with(campaign_, &ImportedColumn::to, "roll_deg");
    const bool parts = roll != nullptr && roll->key == kAttitudeKey;
    const std::string remedy =
        parts ? fmt::format("look at the keys from, order and inverse of {}",
                            key_words(campaign_, kAttitudeKey))
              : fmt::format(
                    "If angles were recorded in another unit, change the key unit of columns.roll_deg and "
                    "columns.pitch_deg of {}{}",
                    campaign_.mapping_file, better_unit(campaign_, "roll_deg", *read / *there));
    warnings_.push_back(
        fmt::format("the rover was tilted by {:.3g} deg in half of the rows, as read from {}; expected is "
                    "about {:.3g} deg, "
                    "by which the ground under the recorded positions is tilted. {}",
                    *read,
                    parts ? sources_of(campaign_, kAttitudeKey)
                          : sources_of(campaign_, "roll_deg") + " and " + sources_of(campaign_, "pitch_deg"),
                    *there, remedy));
  }

  // Recorded angles beside those by which the rover stands on the ground under it, along its heading. A
  // wrong heading turns both angles, and has a warning of its own.
  void judge_sign_of(std::string_view key, double Attitude::*angle) {
    constexpr std::size_t kLeastRows = 10;
    constexpr double kTilted_rad = rad_from_deg(5.0);  // what is less tilted says nothing of a sign
    constexpr double kTurned = -0.5;
    std::vector<double> shares;  // of the ground's angle
    for (const MeasuredDriveSeries& drive : read_.drives)
      for (const DriveSample& sample : drive.samples) {
        const auto point = ground_under(drive, sample);
        if (!point || !std::isfinite(sample.attitude.yaw_rad)) continue;
        const Attitude stands = on_ground(point->normal, sample.attitude.yaw_rad);
        if (std::abs(stands.*angle) < kTilted_rad || !std::isfinite(sample.attitude.*angle)) continue;
        shares.push_back(sample.attitude.*angle / (stands.*angle));
      }
    if (shares.size() < kLeastRows) return;
    const double half = median(std::move(shares));
    const ImportedColumn* const column = column_with(campaign_, &ImportedColumn::to, key);
    if (half > kTurned || column == nullptr) return;
    warnings_.push_back(fmt::format(
        "in half of the rows {}, as read from {}, is {:.3g} times that of the ground under the rover or "
        "less; "
        "expected is about 1 ({} is positive {}). If it was recorded in the other sense, {} of {}",
        key, sources_of(campaign_, column->key), half, key, key == "pitch_deg" ? "nose down" : "left side up",
        column->key == kAttitudeKey ? "look at the keys order and inverse" : "change the key sign",
        key_words(campaign_, column->key)));
  }

  std::optional<sim::GroundPoint> ground_under(const MeasuredDriveSeries& drive,
                                               const DriveSample& sample) const {
    const auto& ground = read_.terrains[drive.terrain].ground;
    if (!ground || !sample.p_MB.allFinite()) return std::nullopt;
    return ground->at(sample.p_MB.x(), sample.p_MB.y());
  }

  static Attitude on_ground(const Eigen::Vector3d& normal, double yaw_rad) {
    const Eigen::Vector3d along = Eigen::AngleAxisd(-yaw_rad, Eigen::Vector3d::UnitZ()) * normal;
    return {.roll_rad = -std::asin(std::clamp(along.y(), -1.0, 1.0)),
            .pitch_rad = std::atan2(along.x(), along.z()),
            .yaw_rad = yaw_rad};
  }

  // Recorded headings beside the way from start to end, on which a drive's mean heading lies.
  void judge_headings() {
    constexpr double kLeast_m = 0.5,
                     kOff_deg = 45.0;  // ways that say something; no rover slides so far aside
    std::vector<double> off;
    for (const MeasuredDriveSeries& drive : read_.drives) {
      if (drive.command.turn_in_place || drive.samples.empty()) continue;
      const DriveSample &first = drive.samples.front(), &last = drive.samples.back();
      const Eigen::Vector2d way =
          (last.p_MB - first.p_MB).head<2>() * (drive.command.speed_m_s < 0.0 ? -1.0 : 1.0);
      if (!(way.norm() > kLeast_m)) continue;
      const double turned = wrapped_rad(last.attitude.yaw_rad - first.attitude.yaw_rad);
      const double heading = first.attitude.yaw_rad + 0.5 * turned;
      const double course = std::atan2(way.y(), way.x()) - drive.command.crab_rad;
      if (std::isfinite(heading)) off.push_back(std::abs(deg_from_rad(wrapped_rad(course - heading))));
    }
    const auto half = median_of(std::move(off));
    if (!half || *half < kOff_deg) return;
    const ImportedColumn* const yaw = column_with(campaign_, &ImportedColumn::to, "yaw_deg");
    if (yaw == nullptr) return;
    warnings_.push_back(fmt::format(
        "in half of the drives the heading is more than {:.3g} deg off the way from start to end, as read "
        "from "
        "{}; expected is less than {:g} deg. {}; if the axes are others, change frame.axes; if the rover "
        "drove "
        "backward, speed_m_s is negative",
        *half, sources_of(campaign_, yaw->key), kOff_deg,
        yaw->key == kAttitudeKey
            ? fmt::format("Look at the keys from, order and inverse of {}",
                          key_words(campaign_, kAttitudeKey))
            : fmt::format(
                  "If headings were recorded in another unit or sense, change the keys unit and sign of "
                  "columns.yaw_deg of {}",
                  campaign_.mapping_file)));
  }

  const ImportedCampaign& campaign_;
  const DriveCampaign& read_;
  std::vector<std::string> warnings_;
};

// The values of a key of the mapping that can't be: the first of them, and how many there are.
struct Impossible {
  const ImportedDrive* drive = nullptr;  // of the first
  const ImportedColumn* column = nullptr;
  const ReadingLimit* limit = nullptr;
  std::size_t row = 0, beyond = 0, values = 0, logs = 0;
  double value = 0.0;

  void add(const ImportedColumn& of, const ImportedDrive& in, std::size_t place, const ReadingLimit& than) {
    const std::size_t before = beyond;
    for (std::size_t i = 0; i < in.rows; ++i) {
      const double read = in.values[place][i];
      values += std::isfinite(read) ? 1U : 0U;
      if (!(std::abs(read) > than.possible)) continue;
      if (beyond++ > 0) continue;
      drive = &in;
      column = &of;
      limit = &than;
      row = i;
      value = read;
    }
    logs += beyond > before ? 1U : 0U;
  }

  Fault fault(const ImportedCampaign& campaign) const {
    return {
        fmt::format("{}#/{}/{}", drive->log, drive->lines[row], column->from),
        fmt::format(
            "{}: {} = {:.4g} {}, can't be beyond {:.3g} {} ({}); so are {} of {} values read by this key, in "
            "{} columns of logs. Change the key {} of {} (it is {}), or leave wrong cells empty",
            place_in_log(*drive, row, column->from), column->to, value, limit->unit, limit->possible,
            limit->unit, limit->possible_since, beyond, values, logs,
            column->key == kAttitudeKey ? "order or inverse" : "unit", key_words(campaign, column->key),
            column->unit)};
  }
};

}  // namespace

std::vector<Fault> impossible_values(const ImportedCampaign& campaign, const DriveCampaign& read) {
  const std::vector<ReadingLimit> limits = reading_limits(read);
  std::vector<Fault> faults;
  std::map<std::string, Impossible> by_key;
  for (std::size_t c = 0; c < campaign.columns.size(); ++c)
    if (const ReadingLimit* const limit = limit_of(limits, campaign.columns[c].to)) {
      Impossible& of_key = by_key[campaign.columns[c].key];
      for (const ImportedDrive& drive : campaign.drives) of_key.add(campaign.columns[c], drive, c, *limit);
    }
  for (const auto& [key, impossible] : by_key)
    if (impossible.drive != nullptr) faults.push_back(impossible.fault(campaign));
  return faults;
}

std::vector<std::string> implausible_readings(const ImportedCampaign& campaign, const DriveCampaign& read) {
  std::vector<std::string> warnings = campaign.warnings;
  for (std::string& warning : wheel_warnings(campaign, read)) warnings.push_back(std::move(warning));
  for (std::string& warning : unit_warnings(campaign, read)) warnings.push_back(std::move(warning));
  for (std::string& warning : Judge(campaign, read).warnings()) warnings.push_back(std::move(warning));
  return warnings;
}

}  // namespace slipway::api
