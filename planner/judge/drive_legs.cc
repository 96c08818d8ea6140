#include "planner/judge/drive_legs.h"

#include <cmath>

namespace slipway::planner {
namespace {

constexpr double kNoTurn_rad = 1e-9, kNoWay_m = 1e-9;
constexpr double kSameCurvature_1_m = 1e-9;

class LegList {
 public:
  LegList(const sim::RoverModel& rover, const Manner& manner) : rover_(rover), manner_(manner) {}

  void turn(double turn_rad) {
    if (std::abs(turn_rad) < kNoTurn_rad) return;
    double whole = turn_rad;
    if (!legs_.empty() && legs_.back().command.turn_in_place) {
      whole += std::copysign(legs_.back().turn_rad, legs_.back().command.turn_rate_rad_s);
      legs_.pop_back();
      if (std::abs(whole) < kNoTurn_rad) return;
    }
    sim::DriveLeg leg{.command = commanded()};
    leg.command.turn_in_place = true;
    leg.command.turn_rate_rad_s = std::copysign(rover_.turn_rate_rad_s, whole);
    leg.turn_rad = std::abs(whole);
    legs_.push_back(leg);
  }

  void drive(double length_m, double curvature_1_m) {
    if (length_m < kNoWay_m) return;
    sim::DriveLeg leg{.command = commanded(), .length_m = length_m};
    // A command's curvature is of its speed's sign: backwards, left of the travel is right of the body.
    leg.command.curvature_1_m = manner_.backwards ? -curvature_1_m : curvature_1_m;
    if (!legs_.empty() && !legs_.back().command.turn_in_place &&
        std::abs(legs_.back().command.curvature_1_m - leg.command.curvature_1_m) < kSameCurvature_1_m) {
      legs_.back().length_m += length_m;
    } else {
      legs_.push_back(leg);
    }
  }

  std::vector<sim::DriveLeg> take() { return std::move(legs_); }

 private:
  sim::DriveCommand commanded() const {
    return {.speed_m_s = manner_.backwards ? -rover_.cruise_speed_m_s : rover_.cruise_speed_m_s,
            .crab_rad = manner_.crab_rad};
  }

  const sim::RoverModel& rover_;
  const Manner& manner_;
  std::vector<sim::DriveLeg> legs_;
};

}  // namespace

std::vector<sim::DriveLeg> drive_legs(const std::vector<Motion>& motions, const sim::RoverModel& rover,
                                      const Manner& manner) {
  LegList legs(rover, manner);
  for (const Motion& motion : motions) {
    legs.turn(motion.first_turn_rad);
    legs.drive(motion.length_m, motion.curvature_1_m);
    legs.turn(motion.last_turn_rad);
  }
  return legs.take();
}

Pose2 drive_start(const std::vector<Motion>& motions, const Manner& manner) {
  const Pose2& from = motions.front().from;
  return {from.x_m, from.y_m, manner.body_yaw(from.yaw_rad)};
}

}  // namespace slipway::planner
