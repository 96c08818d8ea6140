// One verdict: each rule by hand, and what it says of random drives.
#include "planner/judge/drive_verdict.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>

#include "core/angle.h"
#include "core/progress.h"
#include "planner/maps/plane_drives.h"
#include "planner/predict_path.h"
#include "tests/planner/ground_fixture.h"

namespace slipway::planner {
namespace {

constexpr sim::DrawnShare kNever{0.0, 0.0, 0.0098}, kOften{0.2, 0.1, 0.3}, kRarely{0.01, 0.004, 0.02};

sim::DrivePrediction prediction_with(const sim::OutcomeShares& shares) {
  sim::DrivePrediction drive;
  drive.draws = 272;
  drive.wheel_names = {"lf"};
  static_cast<sim::OutcomeShares&>(drive.outcomes) = drive.outcomes.on_known = shares;
  return drive;
}

Verdict judged(const sim::DrivePrediction& drive) {
  return judge_drive(PlanProblem{}, drive).verdict;
}

TEST(DriveVerdict, EachProbabilityHasItsBars) {
  EXPECT_EQ(judged(prediction_with({kNever, kNever, kNever})), Verdict::kGo);
  EXPECT_EQ(judged(prediction_with({{0.1, 0.05, 0.19}, kNever, kNever})), Verdict::kGo);
  EXPECT_EQ(judged(prediction_with({{0.3, 0.2, 0.4}, kNever, kNever})), Verdict::kUnknown);
  EXPECT_EQ(judged(prediction_with({{0.6, 0.51, 0.7}, kNever, kNever})), Verdict::kNoGo);
  EXPECT_EQ(judged(prediction_with({kNever, kRarely, kNever})), Verdict::kUnknown);
  EXPECT_EQ(judged(prediction_with({kNever, kOften, kNever})), Verdict::kNoGo);
  EXPECT_EQ(judged(prediction_with({kNever, kNever, kRarely})), Verdict::kUnknown);
  EXPECT_EQ(judged(prediction_with({kNever, kNever, kOften})), Verdict::kNoGo);
}

TEST(DriveVerdict, WhatGoesWrongOnUnmappedGroundLeavesItOpen) {
  sim::DrivePrediction drive = prediction_with({kOften, kOften, kNever});
  drive.outcomes.on_known = {kNever, kNever, kNever};
  EXPECT_EQ(judged(drive), Verdict::kUnknown);
  drive.broken_limits = {{sim::Rule::kTilt, 0.5, 0.4, 3.0, -1}};
  EXPECT_EQ(judged(drive), Verdict::kNoGo) << "the ground's shape is known";
}

TEST(DriveVerdict, OnTheMeanSoilsEveryLimitHoldsAndTheRoverMoves) {
  const sim::DrivePrediction fine = prediction_with({kNever, kNever, kNever});
  for (const sim::RuleRow& row : sim::rule_catalogue()) {
    if (!row.limit) continue;
    sim::DrivePrediction broken = fine;
    broken.broken_limits = {{row.rule, 0.5, 0.4, 3.0, -1}};
    const DriveVerdict verdict = judge_drive(PlanProblem{}, broken);
    EXPECT_EQ(verdict.verdict, Verdict::kNoGo) << row.name;
    EXPECT_EQ(verdict.rules.front().name, row.name);
    EXPECT_NE(verdict.reasons.front().find("at 3.0 m"), std::string::npos) << verdict.reasons.front();
  }
  sim::DrivePrediction held = fine;
  held.immobilised = {1.0, {}, "no traction at 1.0 m"};
  EXPECT_EQ(judged(held), Verdict::kNoGo);
  sim::DrivePrediction fallen = held;
  fallen.without_stance = {3.0, {}, "no stance at 3.0 m: the ground is too uneven for the suspension"};
  EXPECT_EQ(judge_drive(PlanProblem{}, fallen).rules.front().name, "stance");
}

TEST(DriveVerdict, ASolverThatGivesUpSaysNothingOfTheGround) {
  sim::DrivePrediction drive = prediction_with({kNever, kNever, kNever});
  drive.unsolved = {3.0, {}, "the solver found no balance at 3.0 m, which says nothing of the ground"};
  EXPECT_EQ(judged(drive), Verdict::kUnknown);
}

TEST(DriveVerdict, ALongDriveIsJudgedSegmentBySegment) {
  sim::DrivePrediction drive = prediction_with({{0.9, 0.8, 1.0}, kNever, kNever});
  sim::SegmentRisk fine;
  static_cast<sim::OutcomeShares&>(fine) = {kNever, kNever, kNever};
  drive.outcomes.segments = {fine, fine};
  EXPECT_EQ(judged(drive), Verdict::kGo) << "each sol is a GO";
  drive.outcomes.segments[1].stop = {0.9, 0.8, 1.0};
  EXPECT_EQ(judged(drive), Verdict::kNoGo);
}

TEST(DriveVerdict, SideSlipTakesTheBodyIntoAKeepOutBesideThePath) {
  PlanProblem problem = problem_on(20, 20, 1.0, 1.0, [](double, double) { return 0.0; });
  sim::DrivePrediction drive = prediction_with({kNever, kNever, kNever});
  sim::StationPrediction at;
  at.station.pose = {10.0, 10.0, 0.0};
  drive.stations = {at};
  const double edge = 10.0 - 0.5 * problem.rover->body_width_m - 0.3;
  problem.keep_out = {{{5.0, edge}, {5.0, edge - 1.0}, {15.0, edge - 1.0}, {15.0, edge}}};
  EXPECT_EQ(judge_drive(problem, drive).verdict, Verdict::kGo);
  drive.stations[0].aside_m_p05 = -0.4;  // downhill, to the right
  EXPECT_EQ(judge_drive(problem, drive).verdict, Verdict::kUnknown);
  drive.stations[0].aside_m = -0.4;
  EXPECT_EQ(judge_drive(problem, drive).verdict, Verdict::kNoGo);
  drive.stations[0].aside_m = drive.stations[0].aside_m_p05 = 0.4;
  EXPECT_EQ(judge_drive(problem, drive).verdict, Verdict::kGo) << "to the other side";
}

TEST(DriveVerdict, TheFirstSideSlipThatIsCertainDecidesAndOneThatIsNotIsToldOnce) {
  PlanProblem problem = problem_on(20, 20, 1.0, 1.0, [](double, double) { return 0.0; });
  const double edge = 10.0 - 0.5 * problem.rover->body_width_m - 0.3;
  problem.keep_out = {{{5.0, edge}, {5.0, edge - 1.0}, {15.0, edge - 1.0}, {15.0, edge}}};
  sim::DrivePrediction drive = prediction_with({kNever, kNever, kNever});
  sim::StationPrediction at;
  at.station.pose = {10.0, 10.0, 0.0};
  at.aside_m_p05 = -0.4;
  drive.stations = {at, at};
  EXPECT_EQ(judge_drive(problem, drive).reasons.size(), 1u);
  drive.stations[1].aside_m = -0.4;
  EXPECT_EQ(judge_drive(problem, drive).verdict, Verdict::kNoGo);
  for (sim::StationPrediction& station : drive.stations) {  // backwards along the same way: the other side
    station.station.pose.yaw_rad = std::numbers::pi;
    station.station.backwards = true;
  }
  EXPECT_EQ(judge_drive(problem, drive).verdict, Verdict::kNoGo);
  drive.stations[0].station.backwards = drive.stations[1].station.backwards = false;
  EXPECT_EQ(judge_drive(problem, drive).verdict, Verdict::kGo);
}

TEST(DriveVerdict, TheBodyKeepsTheAreasAlongItsMotions) {
  PlanProblem problem = problem_on(20, 20, 1.0, 1.0, [](double, double) { return 0.0; });
  problem.keep_out = {{{10.0, 8.0}, {12.0, 8.0}, {12.0, 12.0}, {10.0, 12.0}}};
  const sim::DrivePrediction drive = prediction_with({kNever, kNever, kNever});
  const std::vector<Motion> through{straight({4.0, 10.0, 0.0}, 15.0, 10.0)};
  const std::vector<Motion> past{straight({4.0, 4.0, 0.0}, 15.0, 4.0)};
  const DriveVerdict verdict = judge_drive(problem, drive, {.motions = &through});
  EXPECT_EQ(verdict.verdict, Verdict::kNoGo);
  EXPECT_TRUE(verdict.reasons.front().starts_with("the rover's body would enter a keep-out at (9."))
      << verdict.reasons.front();
  EXPECT_EQ(judge_drive(problem, drive, {.motions = &past}).verdict, Verdict::kGo);
  std::swap(problem.keep_in, problem.keep_out);
  const DriveVerdict left = judge_drive(problem, drive, {.motions = &past});
  EXPECT_EQ(left.verdict, Verdict::kNoGo);
  EXPECT_TRUE(left.reasons.front().starts_with("the rover's body would leave a keep-in at (4.00, 4.00)"))
      << left.reasons.front();
}

TEST(DriveVerdict, ADriveInMotionRefutesTheRouteOrLeavesItOpen) {
  const sim::DrivePrediction drive = prediction_with({kNever, kNever, kNever});
  const auto judged_with = [&](const DynamicVerification& dynamic) {
    const DriveVerdict verdict = judge_drive(PlanProblem{}, drive, {.dynamic = &dynamic});
    return std::pair{verdict.verdict, verdict.reasons.front()};
  };
  DynamicVerification dynamic;
  dynamic.reason = "the wheels spin";
  dynamic.distance_m = 4.0;
  EXPECT_EQ(judged_with(dynamic),
            std::pair(Verdict::kUnknown, std::string("no answer from the drive in motion: the wheels spin")));
  dynamic.left_the_route = true;
  EXPECT_EQ(judged_with(dynamic),
            std::pair(Verdict::kUnknown,
                      std::string("neither confirmed nor refuted by the drive in motion: the wheels spin")));
  dynamic.broken_limits = {{sim::Rule::kTilt, 0.5, 0.4, 3.0, -1}};
  const std::pair broken(Verdict::kNoGo,
                         std::string("driven in motion: tilt 28.6 deg at 3.0 m, limit 22.92 deg"));
  EXPECT_EQ(judged_with(dynamic), broken) << "whether it came to an end or not";
  dynamic.end = sim::DriveEnd::kFinished;
  EXPECT_EQ(judged_with(dynamic), broken);
  dynamic.broken_limits = {};
  EXPECT_EQ(judged_with(dynamic).first, Verdict::kGo);
  dynamic.left_the_route = false;
  dynamic.end = sim::DriveEnd::kImmobilised;
  EXPECT_EQ(
      judged_with(dynamic),
      std::pair(Verdict::kNoGo, std::string("driven in motion: immobilised at 4.0 m, the wheels spin")));
}

sim::RuleRisk rule_risk(sim::Rule rule, double trips, double halts) {
  sim::RuleRisk risk;
  risk.rule = rule;
  risk.trips.share = trips;
  risk.halts = halts;
  risk.from_m = 2.0;
  risk.to_m = 8.0;
  return risk;
}

TEST(DriveVerdict, TheReasonOfAProbabilityIsTheRuleBehindIt) {
  sim::DrivePrediction drive = prediction_with({{0.6, 0.51, 0.7}, kNever, kNever});
  EXPECT_EQ(judge_drive(PlanProblem{}, drive).reasons.front().find(';'), std::string::npos)
      << "no rule is known";
  drive.outcomes.rules = {rule_risk(sim::Rule::kStance, 0.6, 0.6),
                          rule_risk(sim::Rule::kEmbedding, 0.0, 0.0)};
  EXPECT_TRUE(
      judge_drive(PlanProblem{}, drive)
          .reasons.front()
          .ends_with(
              "; mostly the wheels find no ground to stand on from 2.0 to 8.0 m, because of rough ground"));
  static_cast<sim::OutcomeShares&>(drive.outcomes) = drive.outcomes.on_known = {kNever, kNever, kOften};
  EXPECT_EQ(judge_drive(PlanProblem{}, drive).reasons.front().find(';'), std::string::npos)
      << "it trips in no draw";
  drive.outcomes.rules[1] = rule_risk(sim::Rule::kEmbedding, 0.2, 0.0);
  EXPECT_TRUE(judge_drive(PlanProblem{}, drive)
                  .reasons.front()
                  .ends_with("; the wheels dig in from 2.0 to 8.0 m, because of the soil"));
  drive.outcomes.rules.pop_back();
  EXPECT_EQ(judge_drive(PlanProblem{}, drive).reasons.front().find(';'), std::string::npos);
  drive.outcomes.unsolved = 0.03;
  EXPECT_TRUE(judge_drive(PlanProblem{}, drive)
                  .reasons.back()
                  .starts_with("in 3.0 % of the draws the solver gave up"));
}

TEST(DriveVerdict, WithoutDrawsTheMeanSoilsDecide) {
  const DriveVerdict verdict = judge_drive(PlanProblem{}, sim::DrivePrediction{});
  EXPECT_EQ(verdict.verdict, Verdict::kGo);
  EXPECT_EQ(verdict.reasons, std::vector<std::string>{"every limit holds on the mean soils"});
}

TEST(DriveVerdict, ASegmentAloneIsJudgedByTheBars) {
  const sim::OutcomeBars bars;
  EXPECT_EQ(judge_segment(bars, {kNever, kNever, kNever}), Verdict::kGo);
  EXPECT_EQ(judge_segment(bars, {kNever, kRarely, kNever}), Verdict::kUnknown);
  EXPECT_EQ(judge_segment(bars, {kNever, kOften, kNever}), Verdict::kNoGo);
}

sim::SoilDistribution widened(sim::SoilDistribution soil, double relative) {
  soil.std = {relative, 0.1 * relative, relative * soil.mean.cohesion_pa,
              relative * 0.3 * soil.mean.friction_angle_rad, relative};
  return soil;
}

PlanProblem plane(double slope_deg, double spread) {
  const double rise = std::tan(rad_from_deg(slope_deg));
  PlanProblem problem = problem_on(60, 60, 1.0, 1.0, [=](double x, double) { return rise * x; });
  problem.beliefs.known[0] = widened(problem.beliefs.known[0], spread);
  problem.risk.draws = 32;
  problem.risk.max_draws = 400;
  return problem;
}

DriveVerdict verdict_of(const PlanProblem& problem, double length_m) {
  NoProgress progress;
  const auto drive =
      predict_path(problem, {{12.0, 30.0, std::nullopt}, {12.0 + length_m, 30.0, std::nullopt}}, progress);
  EXPECT_TRUE(drive);
  return judge_drive(problem, *drive);
}

TEST(DriveVerdict, IsNoBetterOnASteeperPathAndNoWorseOnAShorterOne) {
  for (const double spread : {0.1, 0.3, 0.6}) {
    int before = 0;
    for (const double slope_deg : {0.0, 4.0, 8.0, 12.0, 16.0, 20.0, 24.0}) {
      const int now = severity(verdict_of(plane(slope_deg, spread), 20.0).verdict);
      EXPECT_GE(now, before) << slope_deg << ' ' << spread;
      before = now;
      for (const double shorter_m : {19.99, 12.0, 6.0})
        EXPECT_LE(severity(verdict_of(plane(slope_deg, spread), shorter_m).verdict), now)
            << slope_deg << ' ' << spread << ' ' << shorter_m;
    }
  }
}

TEST(DriveVerdict, AWiderBeliefMakesNoGoOfWhatWasNone) {
  for (const double slope_deg : {4.0, 10.0, 14.0, 18.0}) {
    bool was_go = true;
    for (const double spread : {0.1, 0.3, 0.5, 0.8}) {
      const bool is_go = verdict_of(plane(slope_deg, spread), 15.0).verdict == Verdict::kGo;
      EXPECT_TRUE(was_go || !is_go) << slope_deg << ' ' << spread;
      was_go = is_go;
    }
  }
}

// A reason never says what the verdict denies.
TEST(DriveVerdict, ItsReasonsDoNotContradictIt) {
  for (const double spread : {0.1, 0.4, 0.8}) {
    for (const double slope_deg : {0.0, 6.0, 10.0, 14.0, 20.0, 26.0}) {
      const DriveVerdict verdict = verdict_of(plane(slope_deg, spread), 20.0);
      ASSERT_FALSE(verdict.reasons.empty());
      for (const std::string& reason : verdict.reasons)
        for (const char* const unwanted : {"alike", "both sides", "margin", "caution", "not converged"})
          EXPECT_EQ(reason.find(unwanted), std::string::npos) << reason;
      if (verdict.verdict == Verdict::kGo) {
        EXPECT_EQ(verdict.reasons.front().find("NO-GO"), std::string::npos) << verdict.reasons.front();
        EXPECT_TRUE(verdict.advice.empty());
      }
    }
  }
}

// A map's cell and a check of the same 10 m.
TEST(DriveVerdict, OnAPlaneTheMapSaysWhatACheckSays) {
  int same = 0, all = 0;
  for (const double slope_deg : {0.0, 5.0, 8.0, 11.0, 14.0, 17.0, 20.0, 23.0}) {
    const PlanProblem problem = plane(slope_deg, 0.3);
    const PlaneDrives drives(problem, problem.beliefs.known[0], false, 10.0);
    for (const double sign : {1.0, -1.0}) {
      NoProgress progress;
      const double from = sign > 0.0 ? 12.0 : 34.0;
      const auto drive = predict_path(
          problem, {{from, 30.0, std::nullopt}, {from + sign * 10.0, 30.0, std::nullopt}}, progress);
      ASSERT_TRUE(drive);
      ++all;
      const Verdict by_map = drives.verdict(drives.at(sign * std::tan(rad_from_deg(slope_deg)), 0.0));
      if (by_map == judge_drive(problem, *drive).verdict) ++same;
    }
  }
  EXPECT_GE(same, all - 1) << "of " << all << "; between nodes of 2.5 deg one may lie on either side";
}

}  // namespace
}  // namespace slipway::planner
