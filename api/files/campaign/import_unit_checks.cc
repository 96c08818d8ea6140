#include "api/files/campaign/import_unit_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "api/files/campaign/imported_wheels.h"
#include "core/angle.h"
#include "gap/diagnosis/model/reading_plausibility.h"
#include "sim/rover/drive_command.h"

namespace slipway::api {
namespace {

using gap::DriveCampaign;
using gap::DriveSample;
using gap::MeasuredDriveSeries;
using gap::ReadingLimit;

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

class UnitJudge {
 public:
  UnitJudge(const ImportedCampaign& campaign, const DriveCampaign& read) : campaign_(campaign), read_(read) {}

  std::vector<std::string> warnings() {
    judge_sizes();
    judge_small_sizes();
    judge_temperatures();
    judge_way();
    judge_rates();
    judge_steering();
    return std::move(warnings_);
  }

 private:
  static constexpr std::string_view kTemperature = "_motor_temp_c";
  static constexpr double kWarmest_c = 50.0;

  void judge_sizes() {
    for (const ReadingLimit& limit : reading_limits(read_))
      for (const std::string& key : keys_of(campaign_, limit.column)) {
        if (limit.column == kTemperature && temperature_at_start(key) > kWarmest_c) continue;  // told apart
        if (const auto half = median_of(sizes_of(campaign_, key)); half && *half > limit.likely)
          warnings_.push_back(
              fmt::format("half of the values read from {} are larger than {:.3g} {}; expected is {:.3g} {} "
                          "at most ({}). "
                          "If they were recorded in another unit, change the key unit of {}",
                          sources_of(campaign_, key), *half, limit.unit, limit.likely, limit.unit,
                          limit.likely_since, key_words(campaign_, key)));
      }
  }

  // Values that are far smaller than what is usual of the rover: units of thousands that they don't have.
  void judge_small_sizes() {
    constexpr double kFarBelow = 0.02;
    const double idle_a = read_.rover->drive.no_load_current_a, bus_v = read_.rover->drive.bus_voltage_v;
    const double radius_m = read_.rover->wheels.front().radius_m;
    tell_small("_current_a", kFarBelow * idle_a, idle_a, "A", "of a motor without load");
    tell_small("bus_voltage_v", kFarBelow * bus_v, bus_v, "V", "of the rover's bus");
    tell_small("_sinkage_m", 1e-4 * radius_m, 0.1 * radius_m, "m", "of soft ground, a tenth of the radius");
  }

  void tell_small(std::string_view ending, double least, double usual, std::string_view unit,
                  std::string_view whose) {
    for (const std::string& key : keys_of(campaign_, ending)) {
      const auto half = median_of(sizes_of(campaign_, key));
      if (!half || *half == 0.0 || *half >= least) continue;
      warnings_.push_back(fmt::format(
          "half of the values read from {} are smaller than {:.3g} {}; expected is about {:.3g} {} ({}). "
          "If "
          "they were recorded in another unit, change the key unit of {}",
          sources_of(campaign_, key), *half, unit, usual, unit, whose, key_words(campaign_, key)));
    }
  }

  // Motors that have not driven yet are as warm as what is around them: degrees Fahrenheit of a summer's
  // day would be those of an oven.
  void judge_temperatures() {
    for (const std::string& key : keys_of(campaign_, kTemperature)) {
      const auto half = temperature_at_start(key);
      if (!half || *half <= kWarmest_c) continue;
      warnings_.push_back(fmt::format(
          "at the start of half of the drives motors are warmer than {:.3g} C, as read from {}; expected "
          "is "
          "{:g} C at most before they drive. If temperatures were recorded in another unit, change the key "
          "unit of {} (\"F\" are degrees Fahrenheit, \"K\" kelvins)",
          *half, sources_of(campaign_, key), kWarmest_c, key_words(campaign_, key)));
    }
  }

  std::optional<double> temperature_at_start(const std::string& key) const {
    std::vector<double> first;
    for (std::size_t c = 0; c < campaign_.columns.size(); ++c)
      if (campaign_.columns[c].key == key)
        for (const ImportedDrive& drive : campaign_.drives)
          if (std::isfinite(drive.values[c].front())) first.push_back(drive.values[c].front());
    return median_of(std::move(first));
  }

  // Steering angles beside the commanded ones: degrees and radians differ by 57.
  void judge_steering() {
    constexpr double kSteered_rad = rad_from_deg(3.0), kSmall = 0.05, kLarge = 5.0;
    std::vector<double> shares;
    for (const MeasuredDriveSeries& drive : read_.drives) {
      const auto commanded = sim::wheel_commands(*read_.rover, drive.command);
      for (const DriveSample& sample : drive.samples)
        for (std::size_t k = 0; k < commanded.size(); ++k)
          if (std::abs(commanded[k].steer_rad) > kSteered_rad && std::isfinite(sample.wheels[k].steer_rad) &&
              sample.wheels[k].steer_rad != 0.0)
            shares.push_back(std::abs(sample.wheels[k].steer_rad / commanded[k].steer_rad));
    }
    const auto half = median_of(std::move(shares));
    if (!half || (*half >= kSmall && *half <= kLarge)) return;
    for (const std::string& key : keys_of(campaign_, "_steer_deg"))
      warnings_.push_back(fmt::format(
          "half of the steering angles read from {} are {:.3g} times the commanded ones or {}; expected is "
          "about 1. If angles were recorded in another unit, change the key unit of {}{}",
          sources_of(campaign_, key), *half, *half < 1.0 ? "less" : "more", key_words(campaign_, key),
          better_unit(campaign_, key, *half)));
  }

  void judge_way() {
    const auto half = gap::median_way_share(read_);
    if (!half || keys_of(campaign_, "x_m").empty() ||
        (*half >= gap::kShortestWay && *half <= gap::kLongestWay))
      return;
    const std::string of_clock =
        campaign_.clock_unit.empty()
            ? ""
            : fmt::format("If the clock was recorded in another unit, change the key clock.unit of {}{}. ",
                          campaign_.mapping_file, better_clock(*half));
    warnings_.push_back(fmt::format(
        "half of the drives went {} than {:.3g} times their commanded way; expected is {:g} to {:g} times. "
        "{}If "
        "positions were recorded in another unit, change the key unit of columns.x_m and columns.y_m{}; else "
        "look at speed_m_s of the drives of {}",
        *half < 1.0 ? "less" : "more", *half, gap::kShortestWay, gap::kLongestWay, of_clock,
        better_unit(campaign_, "x_m", *half), campaign_.mapping_file));
  }

  // The clock's unit by which the commanded way would be the one that was gone.
  std::string better_clock(double way_share) const {
    for (const std::string_view unit : {"s", "ms", "us", "ns"}) {
      const double share = way_share * clock_unit_s(campaign_.clock_unit) / clock_unit_s(unit);
      if (share > gap::kShortestWay && share <= gap::kLongestWay) return fmt::format(" to \"{}\"", unit);
    }
    return "";
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
      warnings_.push_back(fmt::format(
          "in half of the drives the wheels turned at less than {:.3g} of the commanded rate, as "
          "read from {}; expected is about 1. If rates were recorded in another unit, change the "
          "key unit of {}{}; if the drive was commanded otherwise, change speed_m_s of the drives",
          *half, sources_of(campaign_, key), key_words(campaign_, key), better_unit(campaign_, key, *half)));
  }

  const ImportedCampaign& campaign_;
  const DriveCampaign& read_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> unit_warnings(const ImportedCampaign& campaign, const DriveCampaign& read) {
  return UnitJudge(campaign, read).warnings();
}

std::string better_unit(const ImportedCampaign& campaign, std::string_view key, double times) {
  constexpr double kNear = 1.6;
  const ImportedColumn* const column = column_with(campaign, &ImportedColumn::key, key);
  if (column == nullptr || !(times > 0.0)) return "";
  std::string words;
  double nearest = std::log(kNear);
  for (const RecordedUnit& unit : units_of(column->to)) {
    const double off = std::abs(std::log(times * unit.factor / std::abs(column->factor)));
    if (unit.zero != 0.0 || off >= nearest) continue;
    nearest = off;
    words = fmt::format(" to \"{}\"", unit.name);
  }
  return words;
}

}  // namespace slipway::api
