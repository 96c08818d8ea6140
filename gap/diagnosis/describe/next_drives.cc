#include "gap/diagnosis/describe/next_drives.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/angle.h"
#include "sim/effects/effect_catalogue.h"
#include "sim/quasi_static/quasi_static.h"

namespace slipway::gap {
namespace {

// What a drive would show, with the error that one drive would leave of each channel.
std::vector<ExpectedReading> outcome(const DriveCampaign& campaign, const ModelState& state,
                                     const NoiseScales& scatter, const NextDrive& drive,
                                     const NextDriveOptions& options) {
  const double tilt = rad_from_deg(drive.tilt_deg), heading = rad_from_deg(drive.heading_deg);
  // Straight uphill the nose is up: negative pitch. Across, headed left of uphill, the right side is up.
  const Attitude attitude{.roll_rad = std::asin(-std::sin(tilt) * std::sin(heading)),
                          .pitch_rad = -std::atan(std::tan(tilt) * std::cos(heading)),
                          .yaw_rad = 0.0};
  const sim::DriveCommand command{
      .speed_m_s = drive.speed_m_s, .curvature_1_m = drive.curvature_1_m, .motor_temp_c = drive.motor_temp_c};
  const sim::Stance stance = sim::stance_on_plane(state.rover, attitude);
  sim::QuasiStaticSolver solver(state.rover, campaign.gravity_m_s2);
  if (state.outside.any()) solver.set_outside(wrench_of(state.outside, state.rover, stance, command));
  sim::Soil soil = state.soils.front();
  // As the last drive met it.
  if (state.soil_drift.any()) strengthen(soil, state.soil_drift.factor({.order = 1.0}));
  const sim::StationState at = solver.solve(stance, soil, command);
  const double speed = std::abs(drive.speed_m_s);
  const bool moves = at.moving();
  std::vector<ExpectedReading> readings{
      {moves ? at.slip_ratio : 1.0, std::max(options.min_slip_error, scatter.slip)},
      {moves ? at.leftward_m_s / speed : 0.0, std::max(options.min_side_slip_error, scatter.side_slip)},
      {moves ? at.yaw_rate_rad_s : 0.0, std::max(options.min_yaw_rate_error_rad_s, scatter.yaw_rate_rad_s)}};
  for (std::size_t w = 0; w < state.rover.wheels.size(); ++w) {
    const sim::WheelState wheel = moves ? at.wheels[w] : sim::WheelState{};
    readings.push_back({wheel.current_a, std::max(options.min_current_error_a,
                                                  scatter.current_share * std::abs(wheel.current_a))});
    readings.push_back({wheel.sinkage_m, std::max(options.min_sinkage_error_m, scatter.sinkage_m)});
  }
  return readings;
}

// Bhattacharyya's distance of two normals.
double distance(const ExpectedReading& a, const ExpectedReading& b) {
  const double variance = 0.5 * (a.error * a.error + b.error * b.error);
  return std::pow(a.value - b.value, 2) / (8.0 * variance) + 0.5 * std::log(variance / (a.error * b.error));
}

// Every drive on planes that is compared, without its information.
std::vector<NextDrive> drives_to_compare(double cruise_speed_m_s, const NextDriveOptions& options) {
  std::vector<NextDrive> drives;
  for (const double tilt : options.tilts_deg)
    for (const double heading : options.headings_deg)
      for (const double share : options.speed_shares)
        for (const double curvature : options.curvatures_1_m)
          for (const double temperature : options.temperatures_c) {
            if (tilt == 0.0 && heading > 0.0) continue;
            drives.push_back({tilt, heading, share * cruise_speed_m_s, curvature, temperature, 0.0});
          }
  return drives;
}

}  // namespace

double information_bits(std::span<const std::vector<ExpectedReading>> outcomes,
                        std::span<const double> probabilities) {
  const double all = std::accumulate(probabilities.begin(), probabilities.end(), 0.0);
  double bits = 0.0;
  for (std::size_t a = 0; a < outcomes.size(); ++a) {
    double alike = 0.0;
    for (std::size_t b = 0; b < outcomes.size(); ++b) {
      double apart = 0.0;
      for (std::size_t i = 0; i < outcomes[a].size(); ++i) apart += distance(outcomes[a][i], outcomes[b][i]);
      alike += probabilities[b] / all * std::exp(-apart);
    }
    bits -= probabilities[a] * std::log2(alike);
  }
  return bits;
}

std::vector<NextDrive> one_of_a_kind(std::vector<NextDrive> drives, const NextDriveOptions& options) {
  std::stable_sort(drives.begin(), drives.end(), [](const NextDrive& a, const NextDrive& b) {
    return a.information_bits > b.information_bits;
  });
  std::vector<NextDrive> chosen;
  for (const NextDrive& d : drives) {
    if (chosen.size() >= static_cast<std::size_t>(options.max_drives) ||
        d.information_bits < options.min_bits)
      break;
    if (std::any_of(chosen.begin(), chosen.end(), [&](const NextDrive& c) {
          return c.heading_deg == d.heading_deg && c.speed_m_s == d.speed_m_s &&
                 std::abs(c.tilt_deg - d.tilt_deg) < options.min_tilt_apart_deg;
        }))
      continue;
    chosen.push_back(d);
  }
  return chosen;
}

std::vector<NextDrive> next_drives(const DriveCampaign& campaign, const NoiseScales& scatter,
                                   std::span<const FittedExplanation* const> explanations,
                                   std::span<const double> probabilities, const NextDriveOptions& options,
                                   const Progress& progress) {
  std::vector<ModelState> states;
  for (const FittedExplanation* e : explanations) states.push_back(e->hypothesis.state(e->x));
  std::vector<NextDrive> drives = drives_to_compare(campaign.rover->cruise_speed_m_s, options);
  for (NextDrive& drive : drives) {
    if (progress.cancelled()) return {};
    std::vector<std::vector<ExpectedReading>> outcomes;
    outcomes.reserve(states.size());
    for (const ModelState& state : states)
      outcomes.push_back(outcome(campaign, state, scatter, drive, options));
    drive.information_bits = information_bits(outcomes, probabilities);
  }
  return one_of_a_kind(std::move(drives), options);
}

}  // namespace slipway::gap
