#include "gap/diagnosis/describe/slices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "core/random.h"
#include "gap/diagnosis/describe/regimes.h"

namespace slipway::gap {
namespace {

constexpr std::size_t kWindows = 90;

std::vector<WindowVariables> made_windows() {
  std::vector<WindowVariables> windows(kWindows);
  for (std::size_t w = 0; w < kWindows; ++w) {
    windows[w].slope_deg = 20.0 * random_uniform(1, w);
    windows[w].slip = random_uniform(2, w);
    windows[w].speed_m_s = w % 3 == 0 ? 0.025 : w % 3 == 1 ? 0.04 : 0.05;
    windows[w].turning = w % 15 == 0 ? 1.0 : 0.0;
  }
  return windows;
}

std::size_t windows_of(const std::vector<Slice>& slices, const std::string& variable, double from,
                       double to) {
  const auto found = std::find_if(slices.begin(), slices.end(), [&](const Slice& s) {
    return s.conditions.size() == 1 && name_of(s.conditions[0].variable) == variable &&
           s.conditions[0].from == from && s.conditions[0].to == to;
  });
  return found == slices.end() ? 0 : found->windows.size();
}

// Two windows of each drive.
std::vector<std::size_t> made_drives() {
  std::vector<std::size_t> drives;
  for (std::size_t w = 0; w < kWindows; ++w) drives.push_back(w / 2);
  return drives;
}

std::vector<Regime> located(const std::vector<double>& squares, LookedAt looked_at) {
  const std::vector<ChannelSquares> channels{{Channel::kCurrent, squares}};
  return regimes_in(slices_of(made_windows()), channels, made_drives(), looked_at, DiagnosisOptions{},
                    [] { return false; });
}

TEST(Slices, AreNeitherOfFewWindowsNorOfNearlyAll) {
  const std::vector<Slice> slices = slices_of(made_windows());
  ASSERT_FALSE(slices.empty());
  for (const Slice& slice : slices) {
    EXPECT_GE(20 * slice.windows.size(), kWindows);
    EXPECT_LE(4 * slice.windows.size(), 3 * kWindows);
    EXPECT_TRUE(std::is_sorted(slice.windows.begin(), slice.windows.end()));
    for (const Condition& c : slice.conditions) EXPECT_LE(c.from, c.to);
  }
  EXPECT_EQ(least_of_slice(20), 3u);
  EXPECT_EQ(least_of_slice(81), 5u);
}

TEST(Slices, HaveTheLowestAndTheHighestFifthsTogether) {
  const std::vector<WindowVariables> windows = made_windows();
  std::vector<double> slopes;
  for (const WindowVariables& w : windows) slopes.push_back(std::round(1e4 * w.slope_deg) / 1e4);
  std::sort(slopes.begin(), slopes.end());
  const std::vector<Slice> slices = slices_of(windows);
  const auto fifth = [&](std::size_t k) { return slopes[k * (kWindows - 1) / 5]; };
  // Ends belong to both sides.
  for (const std::size_t n : {1u, 2u, 3u}) {
    EXPECT_EQ(windows_of(slices, "slope_deg", fifth(0), fifth(n)), n * (kWindows - 1) / 5 + 1) << n;
    EXPECT_EQ(windows_of(slices, "slope_deg", fifth(5 - n), fifth(5)),
              kWindows - (5 - n) * (kWindows - 1) / 5)
        << n;
  }
  EXPECT_EQ(windows_of(slices, "slope_deg", fifth(0), fifth(4)), 0u);
  // Of three values the lowest two and the highest two; of two values none but each: one is nearly all.
  EXPECT_EQ(windows_of(slices, "speed_m_s", 0.025, 0.04), 60u);
  EXPECT_EQ(windows_of(slices, "speed_m_s", 0.04, 0.05), 60u);
  EXPECT_EQ(windows_of(slices, "turning", 0.0, 0.0), 0u);
  EXPECT_EQ(windows_of(slices, "turning", 1.0, 1.0), 6u);
}

TEST(Regimes, OfATraceAreThoseThatFitWhereItIsLarge) {
  // A step at the third fifth, rising beyond it: not only where it is largest.
  const std::vector<WindowVariables> windows = made_windows();
  std::vector<double> squares;
  for (const WindowVariables& w : windows) squares.push_back(w.slope_deg > 8.0 ? w.slope_deg : 0.1);
  const std::vector<Regime> regimes = located(squares, LookedAt::kTrace);
  ASSERT_FALSE(regimes.empty());
  ASSERT_EQ(regimes.front().conditions.size(), 1u);
  EXPECT_EQ(regimes.front().conditions[0].variable, WindowVariable::kSlope);
  EXPECT_NEAR(regimes.front().conditions[0].from, 8.0, 1.5);
  EXPECT_LE(regimes.front().significance, 0.1);
  EXPECT_EQ(located(squares, LookedAt::kGap).front().conditions[0].variable, WindowVariable::kSlope);
}

TEST(Regimes, OfATraceAreNotDecidedByFewWindows) {
  std::vector<ChannelSquares> channels{{Channel::kCurrent, {}}, {Channel::kSlip, {}}};
  for (const WindowVariables& w : made_windows()) {
    channels[0].squares.push_back(w.slope_deg > 8.0 ? 50.0 : 0.1);
    channels[1].squares.push_back(0.5);
  }
  for (const std::size_t stuck : {3u, 40u, 41u, 77u})
    channels[0].squares[stuck] = channels[1].squares[stuck] = 1e4;
  EXPECT_EQ(shares_of(channels).front().channel, Channel::kCurrent);
  EXPECT_GT(shares_of(channels).front().share, 0.8);
  const std::vector<Regime> regimes = located(channels[0].squares, LookedAt::kTrace);
  ASSERT_FALSE(regimes.empty());
  EXPECT_NEAR(regimes.front().conditions[0].from, 8.0, 1.5);
}

TEST(Regimes, OfATraceInFewWindowsHaveTheirChannel) {
  std::vector<ChannelSquares> channels{{Channel::kSlip, std::vector<double>(kWindows, 0.0)},
                                       {Channel::kSinkage, std::vector<double>(kWindows, 0.0)}};
  channels[0].squares[7] = 10.0;
  channels[1].squares[7] = channels[1].squares[8] = 20.0;
  ASSERT_EQ(shares_of(channels).size(), 2u);
  EXPECT_EQ(shares_of(channels).front().channel, Channel::kSinkage);
  EXPECT_NEAR(shares_of(channels).front().share, 0.8, 1e-12);
}

TEST(Regimes, AreNotSeenInScatter) {
  std::vector<double> squares;
  for (std::size_t w = 0; w < kWindows; ++w) squares.push_back(4.0 * random_uniform(9, w));
  EXPECT_TRUE(located(squares, LookedAt::kTrace).empty());
  EXPECT_TRUE(located(squares, LookedAt::kGap).empty());
}

// Noise alone: a channel that half of the drives record, and seven that are looked at together.
int alarms_of(std::size_t channels, std::size_t recorded_one_in) {
  const std::vector<WindowVariables> windows = made_windows();
  const std::vector<Slice> slices = slices_of(windows);
  const std::vector<std::size_t> drives = made_drives();
  int alarms = 0;
  for (std::uint64_t trial = 0; trial < 40; ++trial) {
    std::vector<ChannelSquares> noise;
    for (std::size_t c = 0; c < channels; ++c) {
      noise.push_back({static_cast<Channel>(c), {}});
      for (std::size_t w = 0; w < kWindows; ++w) {
        const double uniform = random_uniform(random_key(70 + c, trial), w);
        // The drives of steep ground have it, so that "recorded" is a slice of its own.
        const bool recorded = recorded_one_in == 1 || windows[w].slope_deg > 10.0;
        noise.back().squares.push_back(recorded ? -1.2 * std::log(1.0 - uniform) : std::nan(""));
      }
    }
    DiagnosisOptions options;
    options.seed = trial;
    alarms +=
        regimes_in(slices, noise, drives, LookedAt::kGap, options, [] { return false; }).empty() ? 0 : 1;
  }
  return alarms;
}

// A tenth is allowed: 4 in 40; 9 and more have a probability of 1.6 %.
TEST(Regimes, AreSeenInPureNoiseNoMoreOftenThanSaid) {
  EXPECT_LE(alarms_of(1, 1), 8) << "one channel";
  EXPECT_LE(alarms_of(1, 2), 8) << "a channel that half of the windows have";
  EXPECT_LE(alarms_of(7, 1), 8) << "seven channels";
}

}  // namespace
}  // namespace slipway::gap
