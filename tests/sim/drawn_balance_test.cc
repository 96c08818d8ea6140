// How draws of the ground are balanced: near enough to the exact balance, and the same however many are asked
// for at a time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "sim/prediction/drive_risk.h"
#include "sim/quasi_static/small_solve.h"
#include "tests/sim/reference_models.h"

namespace slipway::sim {
namespace {

const FunctionGround kHills([](double x, double y) { return 0.4 * std::sin(0.7 * x) * std::cos(0.5 * y); });
const SoilBeliefs kBeliefs{{spread("loam", sandy_loam(), 0.4)}, spread("unknown_ground", loose_sand(), 0.5)};

// On stances as they follow each other on the way, each with a soil of its own, from firm to so loose that
// the rover is held.
TEST(DrawnBalance, IsWithinAThousandthOfTheExactSlip) {
  for (const RoverModel& rover : {six_wheeler(), four_wheeler(SuspensionType::kAveraging)}) {
    QuasiStaticSolver exact(rover, 3.71), drawn(rover, 3.71, Precision::kDraws);
    const SoilDistribution soil = spread("sand", loose_sand(), 0.5);
    double largest = 0.0, largest_sinkage_m = 0.0, largest_current_a = 0.0;
    int moving = 0, held = 0;
    for (std::uint64_t s = 0; s < 400; ++s) {
      const auto stance = settle(rover, kHills, {0.3 * static_cast<double>(s), 1.0, 0.0});
      ASSERT_TRUE(stance);
      SoilNormals z;
      for (int k = 0; k < kSoilDims; ++k) z[k] = random_normal(s / 40, static_cast<std::uint64_t>(k));
      const PerWheel<Soil> under(rover.wheels.size(), draw_soil(soil, z));
      const DriveCommand command{.speed_m_s = rover.cruise_speed_m_s};
      const BalanceGeometry geometry(rover, 3.71, *stance, command);
      const StationState a = exact.solve(*stance, under, command), b = drawn.solve(geometry, under);
      ASSERT_EQ(a.moving(), b.moving()) << s << ' ' << describe(a.outcome) << ' ' << describe(b.outcome);
      ++(a.moving() ? moving : held);
      if (!a.moving()) continue;
      largest = std::max(largest, std::abs(a.slip_ratio - b.slip_ratio));
      for (std::size_t k = 0; k < under.size(); ++k) {
        largest_sinkage_m =
            std::max(largest_sinkage_m, std::abs(a.wheels[k].sinkage_m - b.wheels[k].sinkage_m));
        largest_current_a =
            std::max(largest_current_a, std::abs(a.wheels[k].current_a - b.wheels[k].current_a));
      }
    }
    EXPECT_GT(moving, 100);
    EXPECT_GT(held, 5);
    EXPECT_LT(largest, 1e-3);
    EXPECT_GT(largest, 0.0) << "the two are one, and the test compares nothing";
    EXPECT_LT(largest_sinkage_m, 1e-4);
    EXPECT_LT(largest_current_a, 1e-2);
  }
}

TEST(DrawnBalance, MoreDrawsGoOnFromThoseSoFarAsIfAllWereAskedForAtOnce) {
  const RoverModel rover = six_wheeler();
  std::vector<PathStation> path(40);
  for (std::size_t k = 0; k < path.size(); ++k)
    path[k] = {.pose = {0.3 * static_cast<double>(k), 0.0, 0.0}, .distance_m = 0.3 * static_cast<double>(k)};
  NoProgress progress;
  DrawsSoFar so_far;
  const auto predict = [&](int draws, DrawsSoFar* from) {
    return predict_drive(rover, 3.71, kHills, kBeliefs, path, {}, {.draws = draws, .seed = 3}, 2, progress,
                         {}, from)
        .value();
  };
  const DrivePrediction few = predict(12, &so_far);
  EXPECT_EQ(few.draws, 12);
  const DrivePrediction more = predict(30, &so_far), at_once = predict(30, nullptr);
  ASSERT_EQ(more.draws, 30);
  ASSERT_EQ(at_once.draws, 30);
  EXPECT_EQ(more.risk, at_once.risk);
  EXPECT_EQ(more.outcomes.expected_stops, at_once.outcomes.expected_stops);
  for (std::size_t d = 0; d < 30; ++d) EXPECT_EQ(more.drawn[d].energy_j, at_once.drawn[d].energy_j) << d;
  // One that needs fewer than there are is of the first.
  const DrivePrediction fewer = predict(12, &so_far);
  EXPECT_EQ(fewer.draws, 12);
  EXPECT_EQ(fewer.risk, few.risk);
  EXPECT_EQ(fewer.energy_j_p95, few.energy_j_p95);
  for (std::size_t s = 0; s < path.size(); ++s)
    EXPECT_EQ(more.stations[s].slip_ratio_p95, at_once.stations[s].slip_ratio_p95) << s;
}

TEST(SmallSolve, IsEigensAnswerAtEachSize) {
  for (const int size : {5, 7, 9, 11}) {
    const Eigen::MatrixXd a = Eigen::MatrixXd::Random(size, size);
    const Eigen::VectorXd b = Eigen::VectorXd::Random(size), x = small_solve(a, b);
    EXPECT_LT((a * x - b).norm(), 1e-10) << size;
  }
  // The first pivot is nought.
  Eigen::MatrixXd turned = Eigen::MatrixXd::Zero(9, 9);
  for (int k = 0; k < 9; ++k) turned(k, (k + 1) % 9) = 1.0;
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(9, 1.0, 9.0);
  EXPECT_LT((turned * small_solve(turned, b) - b).norm(), 1e-12);
  EXPECT_FALSE(small_solve(Eigen::MatrixXd(Eigen::MatrixXd::Zero(9, 9)), b).allFinite());
}

}  // namespace
}  // namespace slipway::sim
