#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/pose.h"
#include "sim/prediction/relief_spread.h"
#include "sim/rover/ground.h"

namespace slipway::sim {

// How many rocks at least as wide as D there are on a square metre, up to the widest that is drawn: the
// integral of -dF/dD / (pi D^2 / 4). 0 without rocks.
double rocks_per_m2(const ReliefSpread& spread, double min_width_m);

// Where the rover is known to stand, on the map's own relief: within the radius nothing is drawn, and all of
// it from twice the radius on.
struct StandingPlace {
  Pose2 pose;
  double radius_m = 0.0;  // over 0
};

// One draw of the relief on a ground: a function of the key and the place, as DrawnGround is. The errors are
// normal numbers at the corners of a lattice, blended smoothly with a variance of one everywhere; rocks are a
// Poisson process. The ground must outlive it; used from several threads.
class DrawnRelief final : public Ground {
 public:
  DrawnRelief(const Ground& ground, const ReliefSpread& spread, std::uint64_t key,
              const std::optional<StandingPlace>& standing = {});

  std::optional<GroundPoint> at(double x_m, double y_m) const override;
  std::optional<std::size_t> soil_at(double x_m, double y_m) const override;

 private:
  struct Rise {
    double height_m = 0.0, by_x = 0.0, by_y = 0.0;  // and its gradient
  };
  static Rise noise(std::uint64_t key, double deviation_m, double length_m, double x_m, double y_m);
  bool is_there(double width_m, double x_m, double y_m, double uniform) const;
  Rise rocks(double x_m, double y_m) const;
  Rise drawn_share(double x_m, double y_m) const;

  const Ground& ground_;
  ReliefSpread spread_;
  std::uint64_t key_;
  std::optional<StandingPlace> standing_;
  // Widths at which equal shares of the rocks are wider, from the widest to the least wide.
  std::vector<double> widths_m_;
  double rocks_per_m2_ = 0.0;
};

}  // namespace slipway::sim
