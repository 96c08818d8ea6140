#pragma once

#include <vector>

#include "core/progress.h"
#include "planner/problem/departure.h"
#include "planner/timing/motor_warmth.h"
#include "sim/prediction/drive_prediction.h"
#include "sim/rover/rover_model.h"

namespace slipway::planner {

// Light on level ground and straight to the sun, W/m^2, through an atmosphere that scatters: what is
// scattered out of the beam comes from the whole sky by half. A sketch of Appelbaum and Flood's table (Solar
// radiation on Mars, Solar Energy 45, 1990), whose net flux it has within 0.03 of the light above the
// atmosphere for optical depths up to 1 and a sun higher than 30 deg.
struct Light {
  double beam_w_m2 = 0.0, diffuse_w_m2 = 0.0;
};
Light light_of(double sun_elevation_rad, double sun_distance_au, double optical_depth);

// A predicted drive as it goes through the day. To be used by one thread.
class DriveInTime {
 public:
  // Of a rover without `power` charge stays what it is. All must outlive it. Horizons are looked at here, at
  // 800 places of the way at most; where that is cancelled it must not be used.
  DriveInTime(const Departure& departure, const sim::RoverModel& rover,
              const sim::DrivePrediction& prediction, const Progress& progress);

  // From a departure on, with rules judged; with `keep_stations` also what is at each of them.
  TimedDrive at(std::int64_t departs_ms, bool keep_stations = false,
                const std::optional<ChargingHalt>& halt = std::nullopt) const;

 private:
  // Of a place on the way; motors_w, losses and up are means since the place before.
  struct Place {
    double distance_m, elapsed_s, motors_w;
    MotorLosses losses;
    double x_m, y_m;
    Eigen::Vector3d up;               // of the body; shorter than 1 where it turned
    std::vector<double> horizon_rad;  // all around; empty where it is not known
    // In 1440 directions, each looked at when a body stands close to the horizon there; else NaN.
    mutable std::vector<float> fine_rad = {};
  };
  // How much longer and with how much more energy than on the mean soils.
  struct Pace {
    double time = 1.0, energy = 1.0;
  };
  struct Course;

  void set_paces(const sim::DrivePrediction& prediction);
  Course run(std::int64_t departs_ms, const Pace& pace, const std::optional<ChargingHalt>& halt,
             std::vector<TimedStation>* stations) const;
  void judge(const Course& usual, const Course& slow, TimedDrive& drive) const;
  // Of the sky, whose directions are those over the start.
  sky::Bearing over_level(const Place& place, const sky::Bearing& over_start) const;
  double over_horizon_rad(const Place& place, const sky::Bearing& bearing) const;
  double fine_horizon_rad(const Place& place, double azimuth_rad) const;
  std::optional<double> light_left_s(std::int64_t from_ms, double enough_s) const;

  const Departure& departure_;
  const sim::RoverModel& rover_;
  const std::optional<sim::PowerSupply>& supply_;
  // Where there is air; of the motors also where they are known.
  std::optional<FollowingAir> air_, air_of_motors_;
  std::optional<MotorWarmth> motor_;
  std::vector<Place> places_;
  Pace usual_, slow_;
  mutable std::int64_t lit_from_ms_ = 0, lit_to_ms_ = -1;  // between which the last place is known to be lit
};

}  // namespace slipway::planner
