#include "research/benchmark/location_score.h"

#include <gtest/gtest.h>

#include <vector>

#include "research/benchmark/benchmark_figures.h"

namespace slipway::gap {
namespace {

HiddenTrace trace_at(double slope_deg, Channel channel, double mean_square) {
  HiddenTrace trace;
  trace.drive = "D001";
  trace.at.slope_deg = slope_deg;
  trace.mean_square[static_cast<std::size_t>(channel)] = mean_square;
  return trace;
}

// A current that is off on the two steepest of six stretches.
std::vector<HiddenTrace> steep_current() {
  std::vector<HiddenTrace> truth;
  for (const double slope : {0.0, 3.0, 6.0, 9.0}) truth.push_back(trace_at(slope, Channel::kCurrent, 1.0));
  for (const double slope : {12.0, 15.0}) truth.push_back(trace_at(slope, Channel::kCurrent, 20.0));
  truth.front().mean_square[static_cast<std::size_t>(Channel::kSlip)] = 30.0;
  return truth;
}

Diagnosis told(std::vector<ChannelShare> channels, std::vector<Condition> conditions) {
  Diagnosis d;
  d.verdict = Verdict::kEffects;
  d.effects = {{"gearbox_friction", "", 0.9, {}}};
  d.candidates.push_back({{"gearbox_friction"}, 0.9, std::nullopt, 0});
  const Channel channel = channels.empty() ? Channel::kCurrent : channels.front().channel;
  d.channels_of_effects = std::move(channels);
  if (!conditions.empty()) d.regimes_of_effect.push_back({std::move(conditions), channel, 0.9, 0.3, 0.01});
  return d;
}

TEST(LocationScore, TheChannelIsThatOfTheLargestSumOverStretches) {
  EXPECT_EQ(main_channel(steep_current()), Channel::kCurrent);
  EXPECT_EQ(channel_right(steep_current(), told({{Channel::kCurrent, 0.8}, {Channel::kSlip, 0.2}}, {})),
            true);
  EXPECT_EQ(channel_right(steep_current(), told({{Channel::kSlip, 0.8}, {Channel::kCurrent, 0.2}}, {})),
            false);
}

TEST(LocationScore, NothingSaidIsNotScored) {
  EXPECT_FALSE(main_channel({}));
  EXPECT_FALSE(channel_right({}, told({{Channel::kCurrent, 1.0}}, {})));
  EXPECT_FALSE(slice_overlap({}, told({{Channel::kCurrent, 1.0}}, {})));
  EXPECT_FALSE(channel_right(steep_current(), told({}, {})));
  EXPECT_FALSE(slice_overlap(steep_current(), told({}, {})));
}

TEST(LocationScore, ASliceIsHeldAgainstTheStretchesThatHoldMoreThanTheirShare) {
  const std::vector<ChannelShare> current{{Channel::kCurrent, 1.0}};
  const auto overlap = [&](std::vector<Condition> conditions) {
    return slice_overlap(steep_current(), told(current, std::move(conditions)))->value;
  };
  EXPECT_EQ(overlap({{WindowVariable::kSlope, 11.0, 15.0}}), 1.0);
  EXPECT_EQ(overlap({{WindowVariable::kSlope, 13.0, 15.0}}), 0.5);
  EXPECT_EQ(overlap({{WindowVariable::kSlope, 6.0, 15.0}}), 0.5);
  EXPECT_EQ(overlap({{WindowVariable::kSlope, 0.0, 6.0}}), 0.0);
  // Both conditions have to hold; ends are readings, so that a hair beyond them is within.
  EXPECT_EQ(overlap({{WindowVariable::kSlope, 11.0, 14.95}, {WindowVariable::kTurning, 0.0, 0.0}}), 1.0);
  EXPECT_EQ(overlap({{WindowVariable::kSlope, 11.0, 15.0}, {WindowVariable::kTurning, 1.0, 1.0}}), 0.0);
  // A channel without a slice is not located.
  EXPECT_EQ(overlap({}), 0.0);
}

TEST(LocationScore, IsOfTheSlicesOwnChannel) {
  const Diagnosis slip = told({{Channel::kSlip, 1.0}}, {{WindowVariable::kSlope, 0.0, 0.0}});
  EXPECT_EQ(slice_overlap(steep_current(), slip)->value, 1.0);
  const Diagnosis sinkage = told({{Channel::kSinkage, 1.0}}, {{WindowVariable::kSlope, 0.0, 0.0}});
  EXPECT_EQ(slice_overlap(steep_current(), sinkage)->value, 0.0);
}

TEST(LocationScore, TheMostThatASliceHasIsThatOfTheKeysOwnSlices) {
  // Twenty stretches of ten slopes: the steepest fifth of them, which is one slice; then every second one,
  // which is none.
  std::vector<HiddenTrace> steep, scattered;
  for (int i = 0; i < 20; ++i) {
    steep.push_back(trace_at(i / 2, Channel::kCurrent, i >= 14 ? 9.0 : 1.0));
    scattered.push_back(trace_at(i / 2, Channel::kCurrent, i % 2 == 0 ? 9.0 : 1.0));
  }
  const Diagnosis d = told({{Channel::kCurrent, 1.0}}, {{WindowVariable::kSlope, 8.0, 9.0}});
  EXPECT_NEAR(slice_overlap(steep, d)->value, 4.0 / 6.0, 1e-12);
  EXPECT_EQ(slice_overlap(steep, d)->attainable, 1.0);
  EXPECT_LT(slice_overlap(scattered, d)->attainable, 0.5);
}

TEST(LocationScore, CountsWhereEffectsOfTheLibraryWereHiddenAndNamed) {
  const std::set<std::string> library{"gearbox_friction", "hardpan"};
  HiddenAnswer answer;
  answer.campaign = "s01";
  answer.effects = {"hardpan"};
  answer.traces = steep_current();
  const Diagnosis d = told({{Channel::kCurrent, 1.0}}, {{WindowVariable::kSlope, 11.0, 15.0}});
  // Under another name at the right place: it is located.
  const CaseScore named = score_case(answer, d, library, 1.0);
  EXPECT_EQ(named.channel_right, true);
  EXPECT_EQ(named.slice_overlap, 1.0);
  Diagnosis unknown = d;
  unknown.verdict = Verdict::kUnknown;
  EXPECT_FALSE(score_case(answer, unknown, library, 1.0).channel_right);
  answer.effects = {"tether"};
  EXPECT_FALSE(score_case(answer, d, library, 1.0).slice_overlap);
  answer.effects = {"hardpan"};
  answer.traces.clear();
  EXPECT_FALSE(score_case(answer, d, library, 1.0).channel_right);

  CaseScore other = named;
  other.channel_right = false;
  other.slice_overlap = 0.4;
  other.slice_attainable = 0.8;
  const BenchmarkFigures f = figures_of(std::vector{named, other, CaseScore{}});
  EXPECT_EQ(f.channel_right.hits, 1u);
  EXPECT_EQ(f.channel_right.of, 2u);
  EXPECT_EQ(f.slice_half.hits, 1u);
  EXPECT_NEAR(f.slice_overlap.value(), 0.7, 1e-12);
  EXPECT_NEAR(f.slice_of_attainable.value(), 0.75, 1e-12);
}

}  // namespace
}  // namespace slipway::gap
