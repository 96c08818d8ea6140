#include "api/files/campaign/imported_wheels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/files/campaign/import_attitude.h"
#include "core/angle.h"
#include "core/quantile.h"

namespace slipway::api {
namespace {

using gap::DriveSample;
using gap::MeasuredDriveSeries;
using sim::WheelCommand;

constexpr double kNone = gap::kNotMeasured;

double greatest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values)
    if (std::isfinite(value)) most = std::max(most, std::abs(value));
  return most;
}

}  // namespace

std::optional<double> median_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  return values.empty() ? std::nullopt : std::optional(median(std::move(values)));
}

std::vector<WheelCommand> commands(const sim::RoverModel& rover, const sim::DriveCommand& command) {
  const auto told = sim::wheel_commands(rover, command);
  return {told.begin(), told.end()};
}

double yaw_share_of(const MeasuredDriveSeries& drive) {
  constexpr double kLeast_rad = rad_from_deg(5.0);
  const sim::DriveCommand& command = drive.command;
  const double rate =
      command.turn_in_place ? command.turn_rate_rad_s : command.speed_m_s * command.curvature_1_m;
  double turned = 0.0, last = kNone;
  for (const DriveSample& sample : drive.samples) {
    const double yaw = sample.attitude.yaw_rad;
    if (!std::isfinite(yaw)) continue;
    if (std::isfinite(last)) turned += wrapped_rad(yaw - last);
    last = yaw;
  }
  const double asked = rate * (drive.samples.back().time_s - drive.samples.front().time_s);
  return std::isfinite(last) && std::abs(asked) > kLeast_rad ? turned / asked : kNone;
}

DriveOfWheels drive_of(const sim::RoverModel& rover, const MeasuredDriveSeries& drive) {
  DriveOfWheels of;
  sim::DriveCommand otherwise = drive.command;
  otherwise.curvature_1_m = -otherwise.curvature_1_m;
  otherwise.turn_rate_rad_s = -otherwise.turn_rate_rad_s;
  of.told = commands(rover, drive.command);
  of.told_otherwise = commands(rover, otherwise);
  of.in_place = drive.command.turn_in_place;
  of.turns = of.in_place || drive.command.curvature_1_m != 0.0;
  for (std::size_t k = 0; k < rover.wheels.size(); ++k) {
    std::vector<double> rates, angles;
    for (const DriveSample& sample : drive.samples) {
      rates.push_back(sample.wheels[k].rate_rad_s);
      angles.push_back(sample.wheels[k].steer_rad);
    }
    of.rate_rad_s.push_back(median_of(std::move(rates)).value_or(kNone));
    of.steer_rad.push_back(median_of(std::move(angles)).value_or(kNone));
  }
  if (of.turns && !drive.samples.empty()) of.yaw_share = yaw_share_of(drive);
  return of;
}

std::vector<double> relative(std::vector<double> rates) {
  if (const double most = greatest(rates); most > 0.0)
    for (double& rate : rates) rate /= most;
  return rates;
}

std::vector<double> rates_of(const std::vector<WheelCommand>& told) {
  std::vector<double> rates;
  for (const WheelCommand& wheel : told) rates.push_back(wheel.rate_rad_s);
  return rates;
}

ImportedWheels::ImportedWheels(const ImportedCampaign& campaign, const gap::DriveCampaign& read)
    : campaign_(campaign), rover_(*read.rover) {
  for (const MeasuredDriveSeries& drive : read.drives)
    if (!drive.samples.empty()) drives_.push_back(drive_of(rover_, drive));
  leave_out_steering_in_another_unit();
}

// Radians that were taken for degrees, or the other way round, have a warning of their own.
void ImportedWheels::leave_out_steering_in_another_unit() {
  constexpr double kSmall = 0.05, kLarge = 5.0;
  double told = 0.0, recorded = 0.0;
  for (const DriveOfWheels& drive : drives_) {
    recorded = std::max(recorded, greatest(drive.steer_rad));
    for (const WheelCommand& wheel : drive.told) told = std::max(told, std::abs(wheel.steer_rad));
  }
  if (told == 0.0 || recorded == 0.0 || (recorded > kSmall * told && recorded < kLarge * told)) return;
  for (DriveOfWheels& drive : drives_) std::fill(drive.steer_rad.begin(), drive.steer_rad.end(), kNone);
}

void ImportedWheels::turn_rates(const std::vector<std::size_t>& wheels) {
  for (DriveOfWheels& drive : drives_)
    for (const std::size_t k : wheels) drive.rate_rad_s[k] = -drive.rate_rad_s[k];
}

std::string ImportedWheels::names_of(const std::vector<std::size_t>& wheels) const {
  std::vector<std::string_view> names;
  for (const std::size_t k : wheels) names.push_back(rover_.wheels[k].name);
  return fmt::format("{}", fmt::join(names, ", "));
}

const ImportedColumn* ImportedWheels::column_of(std::size_t wheel, std::string_view ending) const {
  return column_with(campaign_, &ImportedColumn::to, rover_.wheels[wheel].name + std::string(ending));
}

std::string ImportedWheels::remedy(const std::vector<std::size_t>& wheels, std::string_view ending) const {
  const std::string for_all = "{w}" + std::string(ending);
  std::vector<std::string> own, turned;  // wheels with a column of their own; those to be named in `turned`
  bool all_of_key = true;
  for (std::size_t k = 0; k < count(); ++k) {
    const ImportedColumn* const column = column_of(k, ending);
    if (column == nullptr) continue;
    const bool meant = std::find(wheels.begin(), wheels.end(), k) != wheels.end();
    if (column->key != for_all) {
      if (meant) own.push_back(fmt::format("columns.\"{}\"", column->key));
      continue;
    }
    all_of_key = all_of_key && meant;
    if (meant != column->turned) turned.push_back(fmt::format("\"{}\"", rover_.wheels[k].name));
  }
  std::vector<std::string> words;
  if (!own.empty())
    words.push_back(
        fmt::format("change the key sign of {} of {}", fmt::join(own, " and "), campaign_.mapping_file));
  if (own.empty() || own.size() < wheels.size())
    words.push_back(all_of_key ? fmt::format("change the key sign of {}", key_words(campaign_, for_all))
                               : fmt::format("set the key turned = [{}] of {}", fmt::join(turned, ", "),
                                             key_words(campaign_, for_all)));
  return fmt::format("{}", fmt::join(words, " and "));
}

std::string ImportedWheels::sources(const std::vector<std::size_t>& wheels, std::string_view ending) const {
  std::vector<std::string_view> from;
  for (const std::size_t k : wheels)
    if (const ImportedColumn* const column = column_of(k, ending)) from.push_back(column->from);
  return fmt::format("{}", fmt::join(from, ", "));
}

std::string key_words(const ImportedCampaign& campaign, std::string_view key) {
  if (key == kAttitudeKey) return fmt::format("[attitude] of {}", campaign.mapping_file);
  return fmt::format("columns.\"{}\" of {}", key, campaign.mapping_file);
}

std::string sources_of(const ImportedCampaign& campaign, std::string_view key) {
  std::vector<std::string_view> from;
  std::string unit;
  for (const ImportedColumn& column : campaign.columns)
    if (column.key == key && std::find(from.begin(), from.end(), column.from) == from.end()) {
      from.push_back(column.from);
      unit = column.unit;
    }
  return fmt::format("{} (unit {})", fmt::join(from, ", "), unit);
}

}  // namespace slipway::api
