#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "gap/diagnosis/model/drive_window.h"
#include "gap/diagnosis/model/outside_cause.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/rover/effect_setting.h"
#include "sim/rover/rover_model.h"
#include "sim/rover/stance.h"
#include "sim/soil/soil.h"

namespace slipway::gap {

// A rover on soils that may differ in places: what a hypothesis makes of the nominal one.
struct ModelState {
  sim::RoverModel rover;
  std::vector<sim::Soil> soils;             // as DriveCampaign::soils
  std::vector<sim::EffectSetting> effects;  // that are at work on both already; kept for their regions
  double track_left_out = 0.0;              // see kTrackLeftOut
  OutsideForces outside = {};
  SoilDrift soil_drift = {};
  HeadingError heading_error = {};  // recorded headings are off by it; the rover stands along the right ones
};

// How the rover stands where it was: as its suspension does on the map, leant by its wheels' unequal
// sinkages; the same before its wheels sink; or on the plane under its wheels. Which of them a recording's
// attitudes show is for the recording to say. On planes, a window in which no
// attitude was recorded is one station on the mean of its planes: they differ by the map's detail, which
// nothing confirms.
enum class Footing { kSuspension, kUndisturbed, kPlane };

// What was learnt of the difference between model and drives before these were made, as a function of the
// nuisances x (Hypothesis' parameters, effects left out): offset + slope (x - centre), with what is still
// unknown of it.
struct LearntDifference {
  Eigen::VectorXd offset;      // of every observation
  Eigen::MatrixXd slope;       // observations x nuisances
  std::vector<double> centre;  // x
  Eigen::MatrixXd left;        // observations x causes, each of prior deviation 1
};

// Predicts every observation of a campaign's windows at the quasi-static fidelity level: the rover stands
// at the window's measured stations on the map, along the measured headings or along what the state says
// of them, and is commanded what the drive was.
class WindowModel {
 public:
  // Stances of the nominal rover are found here, once. Windows with a station where there is no ground are
  // left out: see used(). Campaign and windows must outlive the model.
  WindowModel(const DriveCampaign& campaign, std::span<const DriveWindow> windows,
              Footing footing = Footing::kSuspension);

  // Predictions start from the balances at this state, and are the faster the nearer theirs is to it. Their
  // numbers do not change by more than the solver's tolerance.
  void start_from(const ModelState& state, std::size_t threads = 1);
  // One number for each observation of each window, in their order. NaN where the rover would not move, but
  // for slip, which is 1 there, and what depends on the stance alone. Same numbers for any number of threads.
  std::vector<double> predict(const ModelState& state, std::size_t threads = 1) const;
  // The same of many states so near one of them that the rover moves where it moves there, and only there:
  // for derivatives.
  struct NearState {
    ModelState state;
    bool same_rover = false;  // only the soils differ
  };
  std::vector<std::vector<double>> predict_near(const ModelState& centre, std::span<const NearState> near,
                                                std::size_t threads = 1) const;

  // Predictions of hypotheses have the difference added: see Hypothesis::predict.
  void learn(LearntDifference difference) { learnt_ = std::move(difference); }
  const LearntDifference* learnt() const { return learnt_ ? &*learnt_ : nullptr; }

  // Whose work this is, until the model ends: once it is cancelled, predictions stop and are NaN, and all
  // that is made of this model asks cancelled() and ends early with numbers that nobody looks at.
  void watch(const Progress& progress) { progress_ = &progress; }
  bool cancelled() const { return progress_ != nullptr && progress_->cancelled(); }

  // Circumstances of a window, of the nominal rover: what a gap may depend on.
  struct Conditions {
    double pitch_rad = 0.0;  // along the travel, positive uphill
    double roll_rad = 0.0;   // positive: left side up
    std::optional<std::size_t> soil;
    bool turning = false;
  };
  const Conditions& conditions(std::size_t window) const { return conditions_[window]; }
  // Root mean square of measured less predicted roll and pitch of the nominal rover before its wheels sink,
  // rad; NaN where none was measured.
  double attitude_misfit_rad() const;
  // Root mean square of measured less these predicted roll and pitch, each about its mean over the campaign:
  // a constant difference is a biased sensor's. NaN as above.
  double attitude_scatter_rad(std::span<const double> predicted) const;
  Footing footing() const { return footing_; }
  bool used(std::size_t window) const { return !stances_[window].empty(); }
  std::size_t observation_count() const { return offsets_.back(); }
  // Index of a window's first observation.
  std::size_t offset(std::size_t window) const { return offsets_[window]; }
  std::span<const DriveWindow> windows() const { return windows_; }
  const DriveCampaign& campaign() const { return campaign_; }

 private:
  struct Place {
    sim::Stance stance;
    sim::PerWheel<std::size_t> soil;  // index under each wheel
  };

  // The balance of a state at a station: what those of states near it start from.
  struct StationStart {
    bool moving = false;
    std::optional<sim::QuasiStaticSolver::Start> balance;  // where all wheels carry
  };
  // The starts of a window's stations, if they are known. `near`: the state is so near theirs that the rover
  // moves where it moved there; `geometries`, if any, are those of its rover at the stations.
  struct From {
    std::span<const StationStart> starts;
    bool near = false;
    std::span<const sim::BalanceGeometry> geometries = {};
  };
  // Of a window's drive, at one of its stations.
  SoilPlace soil_place(std::size_t window, const Place& place) const;
  sim::PerWheel<sim::Soil> soils_at(std::size_t window, const Place& place, const ModelState& state) const;
  std::vector<StationStart> starts_of(std::size_t window, const ModelState& state,
                                      std::span<const Place> places) const;
  // What a rover and all that acts on it from outside bring to the balances at a window's stations; both
  // arguments must outlive it.
  std::vector<sim::BalanceGeometry> geometries_of(std::size_t window, const ModelState& state,
                                                  std::span<const Place> places) const;
  // Index of every drive's first window, and behind them the number of windows.
  std::vector<std::size_t> first_windows() const;
  void predict_window(std::size_t window, const ModelState& state, std::span<const Place> places,
                      const From& from, sim::QuasiStaticSolver& solver, std::span<double> out) const;
  // Where the state's rover stands in a window: `own` holds it where it does not stand as the nominal one.
  std::span<const Place> places_in(std::size_t window, const ModelState& state,
                                   std::vector<Place>& own) const;
  std::optional<Place> place_at(const sim::RoverModel& rover, std::size_t window, const Pose2& pose) const;
  // Of a window's stations, one or as many as it has; empty where one of them has no ground.
  std::vector<Place> places_of(const sim::RoverModel& rover, const HeadingError& heading_error,
                               std::size_t window) const;
  bool stands_as_nominal(const ModelState& state) const;

  const DriveCampaign& campaign_;
  std::span<const DriveWindow> windows_;
  Footing footing_;
  std::vector<std::vector<Place>> stances_;
  std::vector<std::vector<StationStart>> starts_;  // of stances_; or none
  std::vector<Conditions> conditions_;
  // For SoilPlace: middle and half the extent of all used windows' stations, each way.
  Eigen::Vector2d middle_m_ = {0, 0}, half_extent_m_ = {1, 1};
  std::vector<std::size_t> offsets_;
  std::optional<LearntDifference> learnt_;
  const Progress* progress_ = nullptr;
};

}  // namespace slipway::gap
