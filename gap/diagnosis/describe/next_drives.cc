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

constexpr std::array kTilts_deg{0.0, 5.0, 10.0, 15.0};
constexpr std::array kHeadings_deg{0.0, 90.0, 180.0};  // from straight uphill
constexpr std::array kSpeedShares{1.0, 0.5, -1.0};
constexpr std::array kCurvatures_1_m{0.0, 0.3};
constexpr std::array kTemperatures_c{20.0, -40.0};

// What a drive would show, each channel over the error that one drive would leave.
std::vector<double> outcome(const DriveCampaign& campaign, const ModelState& state,
                            const NoiseScales& scatter, const NextDrive& drive) {
  const double tilt = rad_from_deg(drive.tilt_deg), heading = rad_from_deg(drive.heading_deg);
  // Straight uphill the nose is up: negative pitch. Across, headed left of uphill, the right side is up.
  const Attitude attitude{.roll_rad = std::asin(-std::sin(tilt) * std::sin(heading)),
                          .pitch_rad = -std::atan(std::tan(tilt) * std::cos(heading)),
                          .yaw_rad = 0.0};
  sim::QuasiStaticSolver solver(state.rover, campaign.gravity_m_s2);
  const sim::StationState at = solver.solve(sim::stance_on_plane(state.rover, attitude), state.soils.front(),
                                            {.speed_m_s = drive.speed_m_s,
                                             .curvature_1_m = drive.curvature_1_m,
                                             .motor_temp_c = drive.motor_temp_c});
  const double speed = std::abs(drive.speed_m_s);
  std::vector<double> values{(at.moving() ? at.slip_ratio : 1.0) / std::max(0.01, scatter.slip)};
  if (!at.moving()) {
    values.resize(3 + 2 * state.rover.wheels.size(), 0.0);
    return values;
  }
  values.push_back(at.leftward_m_s / speed / std::max(0.01, scatter.side_slip));
  values.push_back(at.yaw_rate_rad_s / std::max(3e-4, scatter.yaw_rate_rad_s));
  for (const sim::WheelState& wheel : at.wheels) {
    values.push_back(wheel.current_a / std::max(0.003, scatter.current_share * std::abs(wheel.current_a)));
    values.push_back(wheel.sinkage_m / std::max(0.001, scatter.sinkage_m));
  }
  return values;
}

// What an outcome is expected to tell of which of the explanations is true, each a normal of deviation 1 in
// every direction: a lower bound, never more than their entropy, nothing where none of them is [Kolchinsky &
// Tracey 2017, section 3, by Bhattacharyya distances].
double information_bits(const std::vector<std::vector<double>>& outcomes,
                        std::span<const double> probabilities) {
  const double all = std::accumulate(probabilities.begin(), probabilities.end(), 0.0);
  double bits = 0.0;
  for (std::size_t a = 0; a < outcomes.size(); ++a) {
    double alike = 0.0;
    for (std::size_t b = 0; b < outcomes.size(); ++b) {
      double square = 0.0;
      for (std::size_t i = 0; i < outcomes[a].size(); ++i)
        square += std::pow(outcomes[a][i] - outcomes[b][i], 2);
      alike += probabilities[b] / all * std::exp(-square / 8.0);
    }
    bits -= probabilities[a] * std::log2(alike);
  }
  return bits;
}

}  // namespace

std::vector<NextDrive> next_drives(const DriveCampaign& campaign, const NoiseScales& scatter,
                                   std::span<const FittedExplanation* const> explanations,
                                   std::span<const double> probabilities, std::size_t most,
                                   const Progress& progress) {
  std::vector<ModelState> states;
  for (const FittedExplanation* e : explanations) states.push_back(e->hypothesis.state(e->x));
  std::vector<NextDrive> drives;
  for (const double tilt : kTilts_deg)
    for (const double heading : kHeadings_deg)
      for (const double share : kSpeedShares)
        for (const double curvature : kCurvatures_1_m)
          for (const double temperature : kTemperatures_c) {
            if (tilt == 0.0 && heading > 0.0) continue;
            if (progress.cancelled()) return {};
            NextDrive drive{tilt,      heading,     share * campaign.rover->cruise_speed_m_s,
                            curvature, temperature, 0.0};
            std::vector<std::vector<double>> outcomes;
            outcomes.reserve(states.size());
            for (const ModelState& state : states)
              outcomes.push_back(outcome(campaign, state, scatter, drive));
            drive.information_bits = information_bits(outcomes, probabilities);
            drives.push_back(drive);
          }
  std::stable_sort(drives.begin(), drives.end(), [](const NextDrive& a, const NextDrive& b) {
    return a.information_bits > b.information_bits;
  });
  // One of a kind: neighbours that say as much are left out.
  std::vector<NextDrive> chosen;
  for (const NextDrive& d : drives) {
    if (chosen.size() >= most || d.information_bits < 1e-3) break;
    if (std::any_of(chosen.begin(), chosen.end(), [&](const NextDrive& c) {
          return c.heading_deg == d.heading_deg && c.speed_m_s == d.speed_m_s &&
                 std::abs(c.tilt_deg - d.tilt_deg) < 6.0;
        }))
      continue;
    chosen.push_back(d);
  }
  return chosen;
}

}  // namespace slipway::gap
