#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/dynamic/cvode_integrator.h"
#include "sim/dynamic/dynamic_drive.h"
#include "sim/dynamic/leg_driver.h"
#include "sim/dynamic/rover_dynamics.h"
#include "sim/rover/stance.h"

namespace slipway::sim {

// One drive at the dynamic fidelity level: the rover settles, follows its legs and is watched on the way. It
// is run once; simulate_drive() is the way in. All arguments must outlive it.
class DriveSimulation {
 public:
  DriveSimulation(const RoverModel& rover, double gravity_m_s2, const Ground& ground, const DriveSoils& soils,
                  std::span<const DriveLeg> legs, const DynamicOptions& options, const DriveSink& sink,
                  Progress& progress);
  Result<DynamicDrive> run(const Stance& stance);

 private:
  const double* state() const { return integrator_.state().data(); }
  Result<void> settle();
  double way_m(const Pose2& from) const;
  Result<void> drive_leg(const DriveLeg& leg);
  DriveLeg rest_of_turn(const DriveLeg& leg, Pose2& leg_start) const;
  bool is_past(const DriveLeg& leg, const Pose2& leg_start) const;
  Result<void> turn_onto(const DriveLeg& leg, const Pose2& leg_start);
  Result<void> drive_piece(const DriveLeg& leg, const Pose2& leg_start);
  void stop_where_done(LegDriver& driver);
  void trim(LegDriver& driver, const DriveLeg& leg);
  void add_progress(const DriveLeg& leg);
  Result<CvodeIntegrator::Step> advance(double stop);
  Result<void> check_pace(double t);
  double done_share() const;
  Error off_ground(Error error);
  void emit_samples(double until);
  void record(double t, const double* y);
  double progress_m(const double* y) const;
  void raise_peaks();
  void watch_belly();
  void note(DriveEvent event);
  void take_events();
  double leg_way_m(const DriveLeg& leg, double share) const;
  void check_leg(const DriveLeg& leg, double share_before);
  void check_progress(const DriveLeg& leg);
  std::string stuck_text(const std::string& what, const DriveSample& sample) const;
  std::string stall_text() const;
  void end(DriveEnd how, std::string reason);
  DynamicDrive finish();

  const RoverModel& rover_;
  const Ground& ground_;
  const DriveSoils& soils_;
  std::span<const DriveLeg> legs_;
  const DynamicOptions& options_;
  const DriveSink& sink_;
  Progress& progress_;
  RoverDynamics dynamics_;
  CvodeIntegrator integrator_;
  std::vector<double> between_;
  DynamicDrive out_;
  LegDriver* driver_ = nullptr;
  Pose2 put_down_;
  std::optional<Pose2> next_start_, belly_looked_;
  int leg_ = 0;
  bool ended_ = false;
  long steps_ = 0, pace_steps_ = 0;
  double pace_s_ = 0.0;
  double whole_s_ = 0.0, now_s_ = 0.0, began_s_ = -1.0, last_sample_s_ = 0.0, recorded_s_ = -1.0;
  double trim_rad_ = 0.0;
  std::optional<double> trimmed_share_;  // of the leg, when the trim was last set
  double before_leg_m_ = 0.0, checked_s_ = 0.0, checked_share_ = 0.0;
  std::optional<double> half_share_;        // of the leg, when half of its cruise was over
  std::optional<DriveSample> before_halt_;  // of the leg, when its cruise was over
};

}  // namespace slipway::sim
