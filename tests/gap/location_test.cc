#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "gap/diagnosis/describe/localise.h"

namespace slipway::gap {
namespace {

bool never() {
  return false;
}

TEST(PermutationP, CountsTheDataAsOneOfTheDraws) {
  const std::vector<double> by_chance{1.0, 2.0, 3.0, 4.0};
  EXPECT_DOUBLE_EQ(p_of_permutations(3.5, by_chance), 2.0 / 5.0);
  EXPECT_DOUBLE_EQ(p_of_permutations(3.0, by_chance), 3.0 / 5.0) << "as large counts";
  EXPECT_DOUBLE_EQ(p_of_permutations(9.0, by_chance), 1.0 / 5.0) << "never 0";
}

DriveSums sums_of(const std::vector<double>& by_drive) {
  DriveSums drives;
  for (std::size_t d = 0; d < by_drive.size(); ++d) drives[d] = {by_drive[d], 0.0, 0.0, 0.0, 0.0};
  return drives;
}

TEST(LargestT, IsTheSumOverTheRootOfTheSquares) {
  const auto as_is = [](std::size_t) { return 1.0; };
  EXPECT_NEAR(largest_t(sums_of({3.0, 4.0}), as_is), 7.0 / 5.0, 1e-14);
  EXPECT_NEAR(largest_t(sums_of({3.0, 4.0}), [](std::size_t d) { return d == 0 ? -1.0 : 1.0; }), 1.0 / 5.0,
              1e-14);
  DriveSums other = sums_of({0.0, 0.0});
  other[0][3] = other[1][3] = 2.0;
  EXPECT_NEAR(largest_t(other, as_is), std::sqrt(2.0), 1e-14) << "the function that shows most";
  EXPECT_EQ(largest_t(sums_of({0.0}), as_is), 0.0);
}

// All drives alike: flipped signs give as much only where all are flipped or none, 2 in 2^10 draws.
TEST(SignFlips, SeeABiasThatAllDrivesShareAndNotOneDrivesOwn) {
  const DriveSums shared = sums_of(std::vector<double>(10, 5.0));
  DriveSums one = sums_of({5.0, 0.1, -0.1, 0.1, -0.1, 0.1, -0.1, 0.1, -0.1, 0.1});
  const std::vector<double> alone = sign_flip_significance(std::vector{shared}, 4000, 1, never);
  ASSERT_EQ(alone.size(), 1U);
  EXPECT_LT(alone[0], 0.006);
  EXPECT_GT(alone[0], 0.0005);
  const std::vector<double> both = sign_flip_significance(std::vector{shared, one}, 4000, 1, never);
  EXPECT_GT(both[1], 0.5);
  EXPECT_GE(both[0], alone[0]) << "more looks, more chance";
  EXPECT_TRUE(sign_flip_significance(std::vector{shared}, 10, 1, [] { return true; }).empty());
}

// Twelve drives along parallel lines, eight windows each, 2 m apart.
std::vector<PlacedWindow> lines() {
  std::vector<PlacedWindow> windows;
  for (std::size_t d = 0; d < 12; ++d)
    for (int k = 0; k < 8; ++k) windows.push_back({0, d, 2.0 * k, static_cast<double>(d), true});
  return windows;
}

// Twelve drives in all directions over one spot, which each of them meets in another window.
constexpr double kSpotX_m = 6.0, kSpotY_m = 5.0;
std::vector<PlacedWindow> star() {
  std::vector<PlacedWindow> windows;
  for (std::size_t d = 0; d < 12; ++d)
    for (int k = 0; k < 8; ++k) {
      const double along_m = 2.0 * (k - static_cast<int>(d % 8)),
                   angle = std::numbers::pi * static_cast<double>(d) / 12.0;
      windows.push_back(
          {0, d, kSpotX_m + along_m * std::cos(angle), kSpotY_m + along_m * std::sin(angle), true});
    }
  return windows;
}

TEST(Places, AreFoundWhereDrivesCrossOneSpot) {
  const std::vector<PlacedWindow> windows = star();
  ChannelSquares of{Channel::kSinkage, {}};
  for (const PlacedWindow& w : windows)
    of.squares.push_back(w.x_m == kSpotX_m && w.y_m == kSpotY_m ? 60.0 : 1.0);
  const std::vector<FoundPlace> places = places_in(windows, std::vector{of}, {}, never);
  ASSERT_FALSE(places.empty());
  for (const FoundPlace& place : places) {
    EXPECT_LE(std::hypot(place.x_m - kSpotX_m, place.y_m - kSpotY_m), place.radius_m) << "the spot is in it";
    EXPECT_EQ(place.channel, Channel::kSinkage);
  }
  const FoundPlace& best =
      *std::max_element(places.begin(), places.end(),
                        [](const FoundPlace& a, const FoundPlace& b) { return a.excess < b.excess; });
  EXPECT_EQ(best.x_m, kSpotX_m);
  EXPECT_EQ(best.y_m, kSpotY_m);
  EXPECT_EQ(best.radius_m, 1.5);
  EXPECT_NEAR(best.share, 720.0 / (720.0 + 84.0), 1e-12) << "twelve of 96 windows";
}

TEST(Places, AreNotSeenInScatterNorInOneDriveAlone) {
  const std::vector<PlacedWindow> windows = lines();
  ChannelSquares scatter{Channel::kSlip, {}}, one_drive{Channel::kSlip, {}};
  for (std::size_t w = 0; w < windows.size(); ++w) {
    scatter.squares.push_back(3.0 * random_uniform(4, w));
    one_drive.squares.push_back(windows[w].drive == 5 && windows[w].x_m == 6.0 ? 500.0 : 1.0);
  }
  EXPECT_TRUE(places_in(windows, std::vector{scatter}, {}, never).empty());
  DiagnosisOptions near;
  near.location.place_radii_m = {0.5, 0.5};
  EXPECT_TRUE(places_in(windows, std::vector{one_drive}, near, never).empty()) << "no other drive met it";
  ChannelSquares below{Channel::kSlip, std::vector<double>(windows.size(), 0.5)};
  below.squares[3] = 5.0;
  EXPECT_TRUE(places_in(windows, std::vector{below}, {}, never).empty())
      << "less than the noise on the whole";
}

// Noise alone, on a map where drives cross each other: what is found is a false alarm.
double exponential(std::uint64_t key, std::uint64_t n) {
  return -std::log(1.0 - random_uniform(key, n));
}

TEST(Places, AreFoundInPureNoiseNoMoreOftenThanSaid) {
  const std::vector<PlacedWindow> windows = star();
  int alarms = 0;
  constexpr int kTrials = 60;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<ChannelSquares> channels;
    for (std::uint64_t c = 0; c < 4; ++c) {
      channels.push_back({static_cast<Channel>(c), {}});
      const std::uint64_t key = random_key(31 + c, static_cast<std::uint64_t>(trial));
      for (std::size_t w = 0; w < windows.size(); ++w) {
        const bool recorded = c == 0 || windows[w].drive % 2 == 0;
        channels.back().squares.push_back(recorded ? 1.2 * exponential(key, w) : std::nan(""));
      }
    }
    DiagnosisOptions options;
    options.seed = static_cast<std::uint64_t>(trial);
    alarms += places_in(windows, channels, options, never).empty() ? 0 : 1;
  }
  // 5 % are allowed: 3 in 60; 8 and more have a probability of 0.7 %.
  EXPECT_LE(alarms, 7);
}

// By hand, two groups of four permutations. What is observed is one of five draws: 5 is the largest of its
// group, as 40 is of the other.
TEST(JointSignificance, CountsThePermutationsThatAreAsRareInAnyGroup) {
  const std::vector<double> rising{1.0, 2.0, 3.0, 4.0};
  const JointSignificance p({{5.0, rising}, {5.0, {40.0, 30.0, 20.0, 10.0}}});
  EXPECT_DOUBLE_EQ(p(0, 5.0), 2.0 / 5.0);
  EXPECT_DOUBLE_EQ(p(0, 3.5), 4.0 / 5.0) << "second of its group: 4, 40 and 30 are as rare";
  const JointSignificance one({{3.5, rising}});
  for (const double own : {0.5, 2.0, 3.5}) EXPECT_DOUBLE_EQ(one(0, own), p_of_permutations(own, rising));
}

// Of the windows' mean m and variance v, n drawn of N without putting back scatter by v / n (N - n) / (N -
// 1).
TEST(Excess, IsInDeviationsOfAsManyWindowsDrawnAtRandom) {
  const std::vector<double> values{0.0, 2.0, 4.0, 6.0};
  const Excess excess(values);
  EXPECT_DOUBLE_EQ(excess.mean(), 3.0);
  EXPECT_DOUBLE_EQ(excess.variance(), 5.0);
  EXPECT_NEAR(excess(values, {{}, {2, 3}}), 2.0 / std::sqrt(5.0 / 2.0 * 2.0 / 3.0), 1e-14);
}

TEST(Reordered, KeepsDrivesTogetherAndEveryWindowOnce) {
  const std::vector<std::size_t> drive_of{0, 0, 1, 1, 1, 2, 3, 3};
  const std::vector<std::size_t> order = reordered(drive_of, random_key(1, 77));
  std::vector<std::size_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t w = 0; w < sorted.size(); ++w) EXPECT_EQ(sorted[w], w);
  int breaks = 0;  // between windows that are no neighbours in a drive, all round
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::size_t a = order[i], b = order[(i + 1) % order.size()];
    breaks += b == a + 1 && drive_of[a] == drive_of[b] ? 0 : 1;
  }
  EXPECT_EQ(breaks, 4) << "one behind each drive";
}

}  // namespace
}  // namespace slipway::gap
