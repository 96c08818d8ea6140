#include "api/files/campaign/import_plausibility.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

#include "api/files/campaign/import_faults.h"
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

std::string key_words(const ImportedCampaign& campaign, std::string_view key) {
  return fmt::format("columns.\"{}\" of {}", key, campaign.mapping_file);
}

// "mA_FL, mA_FR (unit A)": what the columns of a key are read from.
std::string sources_of(const ImportedCampaign& campaign, std::string_view key) {
  std::vector<std::string_view> from;
  std::string unit;
  for (const ImportedColumn& column : campaign.columns)
    if (column.key == key) {
      from.push_back(column.from);
      unit = column.unit;
    }
  return fmt::format("{} (unit {})", fmt::join(from, ", "), unit);
}

// All values of a key's columns by their size.
std::vector<double> sizes_of(const ImportedCampaign& campaign, std::string_view key) {
  std::vector<double> sizes;
  for (std::size_t c = 0; c < campaign.columns.size(); ++c)
    if (campaign.columns[c].key == key)
      for (const ImportedDrive& drive : campaign.drives)
        for (const double value : drive.values[c])
          if (std::isfinite(value)) sizes.push_back(std::abs(value));
  return sizes;
}

std::set<std::string> keys_of(const ImportedCampaign& campaign, std::string_view ending) {
  std::set<std::string> keys;
  for (const ImportedColumn& column : campaign.columns)
    if (column.to.ends_with(ending)) keys.insert(column.key);
  return keys;
}

std::optional<double> median_of(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  return median(std::move(values));
}

class Judge {
 public:
  Judge(const ImportedCampaign& campaign, const DriveCampaign& read) : campaign_(campaign), read_(read) {}

  std::vector<std::string> warnings() {
    judge_sizes();
    judge_way();
    judge_rates();
    judge_tilts();
    judge_sign_of("pitch_deg", &Attitude::pitch_rad);
    judge_sign_of("roll_deg", &Attitude::roll_rad);
    judge_sign_of_currents();
    judge_headings();
    return std::move(warnings_);
  }

 private:
  void judge_sizes() {
    for (const ReadingLimit& limit : reading_limits(read_))
      for (const std::string& key : keys_of(campaign_, limit.column))
        if (const auto half = median_of(sizes_of(campaign_, key)); half && *half > limit.likely)
          warnings_.push_back(
              fmt::format("half of the values read from {} are larger than {:.3g} {}; expected is {:.3g} {} "
                          "at most ({}). If "
                          "they were recorded in another unit, change the key unit of {}",
                          sources_of(campaign_, key), *half, limit.unit, limit.likely, limit.unit,
                          limit.likely_since, key_words(campaign_, key)));
  }

  void judge_way() {
    const auto half = gap::median_way_share(read_);
    if (!half || keys_of(campaign_, "x_m").empty() ||
        (*half >= gap::kShortestWay && *half <= gap::kLongestWay))
      return;
    warnings_.push_back(fmt::format(
        "half of the drives went {} than {:.3g} times their commanded way; expected is "
        "{:g} to "
        "{:g} times. If the clock was recorded in another unit, change the key clock.unit of {}; if "
        "positions "
        "were, change the key unit of columns.x_m and columns.y_m; else look at speed_m_s of the drives",
        *half < 1.0 ? "less" : "more", *half, gap::kShortestWay, gap::kLongestWay, campaign_.mapping_file));
  }

  // Rates below the limit of their size may still be far from the commanded ones.
  void judge_rates() {
    constexpr double kFast = 0.9;  // quantile of a drive's rates: it may stand for most of the time
    constexpr double kSlow = 0.3;
    std::vector<double> shares;
    for (const MeasuredDriveSeries& drive : read_.drives) {
      const double commanded = gap::greatest_commanded_rate(read_, drive);
      std::vector<double> rates;
      for (const DriveSample& sample : drive.samples)
        for (const gap::WheelReading& wheel : sample.wheels)
          if (std::isfinite(wheel.rate_rad_s)) rates.push_back(std::abs(wheel.rate_rad_s));
      if (rates.empty() || !(commanded > 0.0)) continue;
      const auto at =
          rates.begin() + static_cast<std::ptrdiff_t>(kFast * static_cast<double>(rates.size() - 1));
      std::nth_element(rates.begin(), at, rates.end());
      shares.push_back(*at / commanded);
    }
    const auto half = median_of(std::move(shares));
    if (!half || *half >= kSlow) return;
    for (const std::string& key : keys_of(campaign_, "_rate_deg_s"))
      warnings_.push_back(
          fmt::format("in half of the drives the wheels turned at less than {:.3g} of the commanded rate, as "
                      "read from {}; "
                      "expected is about 1. If rates were recorded in another unit, change the key unit of "
                      "{}; if the drive "
                      "was commanded otherwise, change speed_m_s of the drives",
                      *half, sources_of(campaign_, key), key_words(campaign_, key)));
  }

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
    warnings_.push_back(fmt::format(
        "the rover was tilted by {:.3g} deg in half of the rows, as read from {} and {}; expected is about "
        "{:.3g} "
        "deg, by which the ground under the recorded positions is tilted. If angles were recorded in another "
        "unit, change the key unit of columns.roll_deg and columns.pitch_deg of {}",
        *read, sources_of(campaign_, "roll_deg"), sources_of(campaign_, "pitch_deg"), *there,
        campaign_.mapping_file));
  }

  // Recorded angles beside those by which the rover stands on the ground under it, along its heading. A wrong
  // heading turns both angles, and has a warning of its own.
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
    if (half > kTurned) return;
    warnings_.push_back(
        fmt::format("in half of the rows {}, as read from {}, is {:.3g} times that of the ground under the "
                    "rover or less; expected is about 1 ({} is positive {}). If it was recorded in the other "
                    "sense, change the key sign of {}",
                    key, sources_of(campaign_, key), half, key,
                    key == "pitch_deg" ? "nose down" : "left side up", key_words(campaign_, key)));
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

  // A motor that turns its wheel forwards is driven by a positive current, but for one that brakes downhill.
  void judge_sign_of_currents() {
    std::size_t forward = 0, negative = 0;
    for (const MeasuredDriveSeries& drive : read_.drives) {
      const auto commanded = sim::wheel_commands(*read_.rover, drive.command);
      for (const DriveSample& sample : drive.samples)
        for (std::size_t k = 0; k < commanded.size(); ++k) {
          const double current_a = sample.wheels[k].current_a;
          if (!(commanded[k].rate_rad_s > 0.0) || !std::isfinite(current_a)) continue;
          ++forward;
          negative += current_a < 0.0 ? 1 : 0;
        }
    }
    if (2 * negative <= forward) return;
    for (const std::string& key : keys_of(campaign_, "_current_a"))
      warnings_.push_back(fmt::format(
          "{:.0f} % of the currents of wheels that were commanded forwards are negative, as read from {}; "
          "expected are few (motors that brake). If they were recorded in the other sense, change the key "
          "sign of {}",
          100.0 * static_cast<double>(negative) / static_cast<double>(forward), sources_of(campaign_, key),
          key_words(campaign_, key)));
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
    warnings_.push_back(fmt::format(
        "in half of the drives the heading is more than {:.3g} deg off the way from start to end, as read "
        "from {}; "
        "expected is less than {:g} deg. If headings were recorded in another unit or sense, change the keys "
        "unit "
        "and sign of columns.yaw_deg of {}; if the axes are others, change frame.axes; if the rover drove "
        "backward, speed_m_s is negative",
        *half, sources_of(campaign_, "yaw_deg"), kOff_deg, campaign_.mapping_file));
  }

  const ImportedCampaign& campaign_;
  const DriveCampaign& read_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::vector<Fault> impossible_values(const ImportedCampaign& campaign, const DriveCampaign& read) {
  const std::vector<ReadingLimit> limits = reading_limits(read);
  std::vector<Fault> faults;
  for (const ImportedDrive& drive : campaign.drives)
    for (std::size_t c = 0; c < campaign.columns.size(); ++c) {
      const ImportedColumn& column = campaign.columns[c];
      const ReadingLimit* const limit = limit_of(limits, column.to);
      if (limit == nullptr) continue;
      const auto beyond = [&](double value) { return std::abs(value) > limit->possible; };
      const auto first = std::find_if(drive.values[c].begin(), drive.values[c].end(), beyond);
      if (first == drive.values[c].end()) continue;
      const auto row = static_cast<std::size_t>(first - drive.values[c].begin());
      faults.push_back(
          {fmt::format("{}#/{}/{}", drive.log, drive.lines[row], column.from),
           fmt::format(
               "{}: {} = {:.4g} {}, can't be beyond {:.3g} {} ({}); so are {} of {} values. Change the key "
               "unit of {} (it is {}), or leave wrong cells empty",
               place_in_log(drive, row, column.from), column.to, *first, limit->unit, limit->possible,
               limit->unit, limit->possible_since, std::count_if(first, drive.values[c].end(), beyond),
               drive.values[c].size(), key_words(campaign, column.key), column.unit)});
    }
  return faults;
}

std::vector<std::string> implausible_readings(const ImportedCampaign& campaign, const DriveCampaign& read) {
  return Judge(campaign, read).warnings();
}

}  // namespace slipway::api
