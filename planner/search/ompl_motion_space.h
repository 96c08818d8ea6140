#pragma once

#include <ompl/base/MotionValidator.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/base/spaces/SE2StateSpace.h>

#include "planner/search/leg_search.h"

namespace slipway::planner {

// SE(2) in which a rover moves by our motion model. Included by planner/search/ompl_*.cc only.
class MotionSpace final : public ompl::base::SE2StateSpace {
 public:
  explicit MotionSpace(const LegSearch& search);

  // Symmetric and a metric, for nearest neighbours only: metres, and radians at what a turn in place costs.
  double distance(const ompl::base::State* a, const ompl::base::State* b) const override;
  // By the share of the driven length, the first turn done at once.
  void interpolate(const ompl::base::State* from, const ompl::base::State* to, double t,
                   ompl::base::State* state) const override;
  bool hasSymmetricInterpolate() const override { return false; }
  // Its motions are directed. And where a space is a metric one OMPL keeps nearest neighbours in a structure
  // that picks its pivots with process-wide random numbers; otherwise it searches a plain list.
  bool isMetricSpace() const override { return false; }
  ompl::base::StateSamplerPtr allocDefaultStateSampler() const override;

 private:
  const LegSearch& search_;
};

Pose2 pose_of(const ompl::base::State* state);
void set_pose(ompl::base::State* state, const Pose2& pose);

// A motion is valid where its cost is finite: one rule for both.
class FiniteCostValidator final : public ompl::base::MotionValidator {
 public:
  FiniteCostValidator(const ompl::base::SpaceInformationPtr& space, const LegSearch& search);
  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to) const override;
  // The last valid state is not searched for: none of our planners asks.
  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                   std::pair<ompl::base::State*, double>& last_valid) const override;

 private:
  const LegSearch& search_;
};

// The directed cost of motions.
class MotionCostObjective final : public ompl::base::OptimizationObjective {
 public:
  MotionCostObjective(const ompl::base::SpaceInformationPtr& space, const LegSearch& search);
  ompl::base::Cost stateCost(const ompl::base::State* state) const override;
  ompl::base::Cost motionCost(const ompl::base::State* from, const ompl::base::State* to) const override;
  bool isSymmetric() const override { return false; }

 private:
  const LegSearch& search_;
};

// A place with the headings that will do.
class PlaceGoal final : public ompl::base::GoalSampleableRegion {
 public:
  PlaceGoal(const ompl::base::SpaceInformationPtr& space, const LegSearch& search);
  void sampleGoal(ompl::base::State* state) const override;
  unsigned int maxSampleCount() const override;
  double distanceGoal(const ompl::base::State* state) const override;

 private:
  const LegSearch& search_;
  mutable std::size_t next_ = 0;  // a goal belongs to one search on one thread
};

}  // namespace slipway::planner
