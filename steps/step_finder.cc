#include "steps/step_finder.h"

#include <algorithm>
#include <cmath>

namespace slipway::steps {
namespace {

class StepFinder {
 public:
  StepFinder(bool with_attitudes, const SpiceStepOptions& options, SpiceStepSummary& summary)
      : with_attitudes_(with_attitudes), options_(options), summary_(summary) {}

  void add(const PlacedState& state) {
    if (with_attitudes_ && !state.attitude) {
      ++summary_.without_attitude;
      last_.reset();
      phase_ = Phase::kNothing;
      return;
    }
    if (last_) follow(*last_, state);
    last_ = state;
  }

  std::vector<FoundStep> take() { return std::move(found_); }

 private:
  enum class Phase { kNothing, kDrives, kRests };

  void follow(const PlacedState& from, const PlacedState& to) {
    const Eigen::Vector3d move_m = to.position_m - from.position_m;
    if (to.et_s - from.et_s > options_.longest_gap_s) {
      ++summary_.gaps;
      phase_ = Phase::kNothing;
    } else if (move_m.norm() < options_.rest_m) {
      if (phase_ == Phase::kDrives) phase_ = Phase::kRests;
    } else if (with_attitudes_ ? turned(from, to) : !may_correct(move_m)) {
      drive(from, to, move_m);
    } else {
      if (phase_ == Phase::kRests) {
        step_.correction_m = move_m;
        found_.push_back(step_);
      } else {
        ++summary_.jumps_without_drive;
      }
      phase_ = Phase::kNothing;
    }
  }

  bool turned(const PlacedState& from, const PlacedState& to) const {
    return from.attitude->angularDistance(*to.attitude) > options_.turn_rad;
  }

  // Whether a move may be a correction of the step so far, by its length and direction alone.
  bool may_correct(const Eigen::Vector3d& move_m) const {
    if (phase_ != Phase::kRests) return false;
    const double length_m = move_m.norm();
    const double step_m = step_.driven_m.norm();
    if (length_m > step_m || move_m.dot(step_.driven_m) > options_.most_forward * step_m * step_m)
      return false;
    return std::none_of(options_.default_steps_m.begin(), options_.default_steps_m.end(), [&](double each_m) {
      return std::abs(length_m - each_m) < options_.default_step_slack_m;
    });
  }

  // Rests within a step do not end it: rovers stop to look and go on without a correction.
  void drive(const PlacedState& from, const PlacedState& to, const Eigen::Vector3d& move_m) {
    if (phase_ == Phase::kNothing) {
      step_ = {};
      step_.start = from;
    }
    step_.driven_m += move_m;
    step_.drive_s += to.et_s - from.et_s;
    step_.end = to;
    phase_ = Phase::kDrives;
  }

  bool with_attitudes_;
  const SpiceStepOptions& options_;
  SpiceStepSummary& summary_;
  Phase phase_ = Phase::kNothing;
  std::optional<PlacedState> last_;
  FoundStep step_;
  std::vector<FoundStep> found_;
};

}  // namespace

std::vector<FoundStep> find_steps(const std::vector<PlacedState>& states, bool with_attitudes,
                                  const SpiceStepOptions& options, SpiceStepSummary& summary) {
  StepFinder finder(with_attitudes, options, summary);
  for (const PlacedState& state : states) finder.add(state);
  return finder.take();
}

}  // namespace slipway::steps
