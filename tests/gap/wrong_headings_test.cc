// Headings that are recorded wrongly place a rover wrongly on a slope: one that was diagnosed on hills with
// changes of heading 12 % too small was taken for a larger wheel, since only its yaw rate and side slip were
// turned back.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/angle.h"
#include "gap/diagnosis/model/hypothesis.h"
#include "sim/quasi_static/quasi_static.h"
#include "tests/sim/reference_models.h"

namespace slipway::gap {
namespace {

constexpr double kSpeed_m_s = 0.05, kCurvature_1_m = 0.25, kFirstYaw_rad = 2.5;

// An arc on a plane, as the balance has the rover move there, recorded along `heading_of` what it
// has turned.
template <class Heading>
DriveCampaign arc_recorded_along(const Heading& heading_of, double speed_m_s, double slope_deg = 12.0) {
  const double slope = std::tan(rad_from_deg(slope_deg));
  const auto ground =
      std::make_shared<sim::FunctionGround>([slope](double x, double /*y*/) { return slope * x; });
  DriveCampaign campaign;
  campaign.gravity_m_s2 = 3.71;
  campaign.rover = std::make_shared<sim::RoverModel>(sim::six_wheeler());
  campaign.measurement_std = {0.003, 0.003, 0.02, 0.003, 0.001};
  campaign.soils.push_back({"soil", sim::sandy_loam()});
  campaign.terrains.push_back({"plane", ground, ""});
  MeasuredDriveSeries drive;
  drive.id = "arc";
  drive.command.speed_m_s = speed_m_s;
  drive.command.curvature_1_m = kCurvature_1_m;
  drive.duration_s = 144.0;
  sim::QuasiStaticSolver solver(*campaign.rover, campaign.gravity_m_s2);
  Pose2 pose{3.0, -2.0, kFirstYaw_rad};  // passes pi
  for (int i = 0; i <= 144; ++i) {
    const auto stance = sim::settle(*campaign.rover, *ground, pose);
    DriveSample sample;
    sample.time_s = i;
    sample.p_MB = stance->p_MB;
    sample.attitude = stance->attitude;
    sample.attitude.yaw_rad = wrapped_rad(heading_of(pose.yaw_rad - kFirstYaw_rad));
    sample.wheels = sim::PerWheel<WheelReading>(6);
    drive.samples.push_back(sample);
    const sim::StationState state = solver.solve(*stance, sim::sandy_loam(), drive.command);
    const Eigen::AngleAxisd half_turn(0.5 * state.yaw_rate_rad_s, Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d way =
        half_turn * stance->R_MB * Eigen::Vector3d(state.forward_m_s, state.leftward_m_s, 0.0);
    pose.x_m += way.x();
    pose.y_m += way.y();
    pose.yaw_rad += state.yaw_rate_rad_s;
  }
  campaign.drives.push_back(drive);
  return campaign;
}

struct Row {
  Channel channel;
  double measured = 0.0, predicted = 0.0;
};

// Predicted with a cause from outside of this value, or with none.
std::vector<Row> rows_of(const DriveCampaign& campaign, const std::string& cause, double value) {
  const std::vector<DriveWindow> windows = cut_windows(campaign);
  const WindowModel model(campaign, windows);
  std::vector<EffectVariant> causes;
  if (!cause.empty()) {
    causes.push_back(find_outside(cause)->variants(campaign).front());
    causes.back().effect = cause;
  }
  const Hypothesis hypothesis(campaign, causes);
  std::vector<double> x = hypothesis.neutral();
  if (!cause.empty()) x.back() = value;
  const std::vector<double> predicted = hypothesis.predict(model, x);
  std::vector<Row> rows;
  for (std::size_t w = 0; w < windows.size(); ++w)
    for (std::size_t i = 0; i < windows[w].observations.size(); ++i)
      rows.push_back({windows[w].observations[i].channel, windows[w].observations[i].value,
                      predicted[model.offset(w) + i]});
  return rows;
}

double largest_difference(const std::vector<Row>& rows) {
  double largest = 0.0;
  for (const Row& row : rows) largest = std::max(largest, std::abs(row.measured - row.predicted));
  return largest;
}

// The drive is told with its headings supposed to be as wrong as they are, and not without.
void expect_told(const DriveCampaign& campaign, const std::string& cause, double value) {
  for (const Row& row : rows_of(campaign, cause, value)) {
    const bool angle = row.channel == Channel::kRoll || row.channel == Channel::kPitch;
    // Sunk wheels lean the rover by a tenth of a degree.
    EXPECT_NEAR(row.measured, row.predicted, angle ? rad_from_deg(0.2) : 0.005) << name_of(row.channel);
  }
  EXPECT_GT(largest_difference(rows_of(campaign, "", 0.0)), 0.03) << "headings so wrong would show";
}

TEST(WrongHeadings, OfAnotherScaleAreTurnedBackOnASlopeForwardAndBackward) {
  for (const double gain : {-0.12, 0.0, 0.08})
    for (const double speed : {kSpeed_m_s, -kSpeed_m_s}) {
      SCOPED_TRACE(std::to_string(gain) + " at " + std::to_string(speed));
      const DriveCampaign campaign =
          arc_recorded_along([gain](double turned) { return kFirstYaw_rad + (1.0 + gain) * turned; }, speed);
      if (gain != 0.0)
        expect_told(campaign, "heading_gain", gain);
      else
        EXPECT_LT(largest_difference(rows_of(campaign, "", 0.0)), 0.005) << "right headings";
    }
}

TEST(WrongHeadings, FromAnotherZeroAreTurnedBackOnASlope) {
  expect_told(arc_recorded_along([](double turned) { return kFirstYaw_rad + turned + 0.1; }, kSpeed_m_s),
              "heading_offset", 0.1);
  // On a steep one only level motion may be turned: the body's own is 0.01 off.
  expect_told(
      arc_recorded_along([](double turned) { return kFirstYaw_rad + turned - 0.2; }, kSpeed_m_s, 20.0),
      "heading_offset", -0.2);
}

// Positions in another scale read the way aside in it as well.
TEST(WrongDistances, ScaleSlipAndSideSlipAlike) {
  constexpr double kGain = 0.2;
  DriveCampaign campaign =
      arc_recorded_along([](double turned) { return kFirstYaw_rad + turned; }, kSpeed_m_s, 18.0);
  const Eigen::Vector3d first = campaign.drives.front().samples.front().p_MB;
  for (DriveSample& sample : campaign.drives.front().samples)
    sample.p_MB.head<2>() = first.head<2>() + (1.0 + kGain) * (sample.p_MB - first).head<2>();
  double most_aside = 0.0;
  for (const Row& row : rows_of(campaign, "distance_gain", kGain)) {
    if (row.channel != Channel::kSlip && row.channel != Channel::kSideSlip) continue;
    EXPECT_NEAR(row.measured, row.predicted, 0.002) << name_of(row.channel);
    if (row.channel == Channel::kSideSlip) most_aside = std::max(most_aside, std::abs(row.measured));
  }
  EXPECT_GT(kGain / (1.0 + kGain) * most_aside, 0.01) << "which could be missed";
}

TEST(WrongHeadings, ATurnInPlaceReadsSlower) {
  DriveCampaign campaign =
      arc_recorded_along([](double turned) { return kFirstYaw_rad + turned; }, kSpeed_m_s);
  MeasuredDriveSeries& drive = campaign.drives.front();
  drive.command = {.speed_m_s = 0.0, .turn_in_place = true, .turn_rate_rad_s = 0.05};
  const DriveSample first = drive.samples.front();
  for (std::size_t i = 0; i < drive.samples.size(); ++i) {
    drive.samples[i] = first;
    drive.samples[i].time_s = static_cast<double>(i);
    drive.samples[i].attitude.yaw_rad = wrapped_rad(kFirstYaw_rad + 0.045 * static_cast<double>(i));
  }
  const auto slip_of = [&](const std::string& cause, double value) {
    for (const Row& row : rows_of(campaign, cause, value))
      if (row.channel == Channel::kSlip) return row.predicted;
    return kNotMeasured;
  };
  const double right = slip_of("", 0.0);
  EXPECT_NEAR(1.0 - slip_of("heading_gain", -0.12), 0.88 * (1.0 - right), 0.01)
      << "a rate that reads 12 % less";
  EXPECT_NEAR(slip_of("heading_offset", 0.1), right, 0.01) << "rates have no zero";
}

// Turning is counted from the line through the first window's headings: a first row without a heading, or
// with one that nobody would believe, changes nothing.
TEST(WrongHeadings, AreCountedFromTheFirstWindowWhateverItsFirstRowSays) {
  const auto slow = [](double turned) { return kFirstYaw_rad + 0.88 * turned; };
  const std::vector<Row> whole = rows_of(arc_recorded_along(slow, kSpeed_m_s), "heading_gain", -0.12);
  for (const double first : {0.0, kNotMeasured}) {
    DriveCampaign campaign = arc_recorded_along(slow, kSpeed_m_s);
    campaign.drives.front().samples.front().attitude.yaw_rad = first;
    const std::vector<Row> rows = rows_of(campaign, "heading_gain", -0.12);
    ASSERT_EQ(rows.size(), whole.size());
    for (std::size_t i = rows.size() / 2; i < rows.size(); ++i)
      EXPECT_NEAR(rows[i].predicted, whole[i].predicted, 2e-3)
          << name_of(rows[i].channel) << " after " << first;
  }
}

// Derivatives near a state whose headings are turned, from balances at another, are those of predictions.
TEST(WrongHeadings, HaveTheDerivativesOfTheirPredictions) {
  const DriveCampaign campaign =
      arc_recorded_along([](double turned) { return kFirstYaw_rad + 0.88 * turned; }, kSpeed_m_s);
  const std::vector<DriveWindow> windows = cut_windows(campaign);
  WindowModel model(campaign, windows);
  std::vector<EffectVariant> causes{find_outside("heading_gain")->variants(campaign).front()};
  causes.back().effect = "heading_gain";
  const Hypothesis hypothesis(campaign, causes);
  std::vector<double> x = hypothesis.neutral();
  model.start_from(hypothesis.state(x));
  x.back() = -0.12;
  const Eigen::MatrixXd jacobian = hypothesis.scaled_jacobian(model, x, 1);
  const double step = 1e-3, std = hypothesis.parameters().back().std;
  std::vector<double> above = x, below = x;
  above.back() += step;
  below.back() -= step;
  const std::vector<double> high = hypothesis.predict(model, above), low = hypothesis.predict(model, below);
  double largest = 0.0;
  for (std::size_t i = 0; i < high.size(); ++i) {
    const double slope = std * (high[i] - low[i]) / (2.0 * step);
    largest = std::max(largest, std::abs(slope));
    EXPECT_NEAR(jacobian(static_cast<Eigen::Index>(i), jacobian.cols() - 1), slope,
                1e-3 + 0.05 * std::abs(slope))
        << i;
  }
  EXPECT_GT(largest, 0.01);
}

}  // namespace
}  // namespace slipway::gap
