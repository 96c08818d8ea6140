#include "api/files/campaign/import_wheel_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "api/files/campaign/import_wheel_order.h"
#include "api/files/campaign/imported_wheels.h"
#include "sim/rover/drive_command.h"

namespace slipway::api {
namespace {

using gap::DriveSample;
using gap::MeasuredDriveSeries;

// Of drives that don't turn in place every wheel rolls the way that the rover goes.
std::optional<std::string> sense_of_rates(ImportedWheels& wheels) {
  std::vector<std::size_t> turned;
  for (std::size_t k = 0; k < wheels.count(); ++k) {
    std::vector<double> shares;
    for (const DriveOfWheels& drive : wheels.drives())
      if (!drive.in_place && drive.told[k].rate_rad_s != 0.0)
        shares.push_back(relative(drive.rate_rad_s)[k] / relative(rates_of(drive.told))[k]);
    if (const auto half = median_of(std::move(shares)); half && *half < kOtherSense) turned.push_back(k);
  }
  if (turned.empty()) return std::nullopt;
  wheels.turn_rates(turned);
  return fmt::format(
      "the wheels {} turned against the commanded sense in most drives, as read from {}; expected is that "
      "positive rates roll forwards. If they were recorded in the other sense, {}{}",
      wheels.names_of(turned), wheels.sources(turned, kRateColumn), wheels.remedy(turned, kRateColumn),
      turned.size() == wheels.count() ? "; if the rover drove backward, speed_m_s is negative" : "");
}

// How the currents of a wheel may be signed, the expected way first.
enum Sense : std::size_t { kWhereDriving, kTurned, kOfRate, kAgainstRate, kSenses };

// In which sense most currents of each wheel were recorded. A motor that drives its wheel has a positive
// current whichever way it turns; those that brake downhill have not, so drives down a slope say nothing.
std::vector<Sense> senses_of_currents(const ImportedWheels& wheels, const gap::DriveCampaign& read) {
  constexpr double kDown = 0.1;  // of the way: what lies steeper may be braked
  std::vector<std::array<std::size_t, kSenses>> rows(wheels.count());
  for (const MeasuredDriveSeries& drive : read.drives) {
    if (drive.samples.empty()) continue;
    const Eigen::Vector3d way = drive.samples.back().p_MB - drive.samples.front().p_MB;
    if (way.z() < -kDown * way.head<2>().norm()) continue;
    const auto told = sim::wheel_commands(wheels.rover(), drive.command);
    for (const DriveSample& sample : drive.samples)
      for (std::size_t k = 0; k < wheels.count(); ++k) {
        const double current_a = sample.wheels[k].current_a;
        if (!std::isfinite(current_a) || current_a == 0.0) continue;
        ++rows[k][current_a > 0.0 ? kWhereDriving : kTurned];
        ++rows[k][current_a * told[k].rate_rad_s > 0.0 ? kOfRate : kAgainstRate];
      }
  }
  std::vector<Sense> senses;
  for (const auto& of_wheel : rows)
    senses.push_back(
        static_cast<Sense>(std::max_element(of_wheel.begin(), of_wheel.end()) - of_wheel.begin()));
  return senses;
}

std::optional<std::string> sense_of_currents(const ImportedWheels& wheels, const gap::DriveCampaign& read) {
  const std::vector<Sense> senses = senses_of_currents(wheels, read);
  std::vector<std::size_t> turned, by_rate, any;
  for (std::size_t k = 0; k < wheels.count(); ++k) {
    if (senses[k] == kTurned || senses[k] == kAgainstRate) turned.push_back(k);
    if (senses[k] == kOfRate || senses[k] == kAgainstRate) by_rate.push_back(k);
    if (senses[k] != kWhereDriving) any.push_back(k);
  }
  if (any.empty()) return std::nullopt;
  const std::string expected =
      "expected is that they are positive wherever a motor drives, backwards too, and negative where it "
      "brakes";
  const std::string turn = turned.empty() ? "" : wheels.remedy(turned, kCurrentColumn);
  if (by_rate.empty())
    return fmt::format(
        "most of the currents of {} are negative where the rover does not drive downhill, as read from {}; "
        "{}. "
        "If they were recorded in the other sense, {}",
        wheels.names_of(turned), wheels.sources(turned, kCurrentColumn), expected, turn);
  return fmt::format(
      "most of the currents of {} have a sign that goes with the sense in which the wheel turns, as read "
      "from "
      "{}; {}. If they were recorded so, set the key signed_by = \"rate\" of {}{}",
      wheels.names_of(any), wheels.sources(any, kCurrentColumn), expected,
      key_words(wheels.campaign(), wheels.column_of(by_rate.front(), kCurrentColumn)->key),
      turn.empty() ? "" : " and " + turn);
}

}  // namespace

std::vector<std::string> wheel_warnings(const ImportedCampaign& campaign, const gap::DriveCampaign& read) {
  ImportedWheels wheels(campaign, read);
  std::vector<std::string> warnings;
  if (auto rates = sense_of_rates(wheels)) warnings.push_back(std::move(*rates));
  for (std::string& warning : order_warnings(wheels)) warnings.push_back(std::move(warning));
  if (auto currents = sense_of_currents(wheels, read)) warnings.push_back(std::move(*currents));
  return warnings;
}

}  // namespace slipway::api
