#pragma once

#include <vector>

namespace slipway::sim {

// The way that wheels roll for each metre that the rover comes, 1 / u of slip_ratio.h. Slips beyond 0.999
// either way count as 0.999, so that neither the rover nor its wheels stand still.
double roll_per_way(double slip_ratio);

// How far behind a rover is that is commanded by the way its wheels roll, without a look at where it is.
//
// With u(x) = v / (r w) at the place x of the path, 1 - i of a slip i and 1 / (1 + i) of a skid
// (slip_ratio.h), the wheels roll dr = dx / u. A drive commanded to r ends at the x with r = integral from 0
// to x of dx' / u(x'); its shortfall is r - x, below 0 where the rover skids downhill. Behind the last
// station its slip goes on. Heading errors and side slip are not in it.
class ShortfallFollower {
 public:
  // The rolled distances at which it is asked for, rising, in metres.
  explicit ShortfallFollower(const std::vector<double>& rolled_m) : wanted_m_(rolled_m) {}

  // The rover comes `way_m` further along its path at this slip.
  void add(double way_m, double slip_ratio);
  // The shortfall at each of the rolled distances. Where the rover is stuck it stays where it is, and its
  // wheels roll on.
  std::vector<float> finish(bool stuck);

 private:
  const std::vector<double>& wanted_m_;
  std::vector<float> shortfall_m_;
  double rolled_m_ = 0.0, come_m_ = 0.0;
  double roll_per_way_ = 1.0;  // of the last part
};

// How far beside its path a rover comes, and how far from its heading, that is commanded by its wheels
// without a look at where it is: side slip adds to the way aside, unequal slip left and right to the heading,
// which in turn leads aside.
class DriftFollower {
 public:
  // The distances along the path at which it is asked for, rising, in metres.
  explicit DriftFollower(const std::vector<double>& come_m) : wanted_m_(come_m) {}

  // The rover comes `way_m` further at this side slip, while its heading leaves that of the path by
  // `turned_rad`; angles are positive to the left.
  void add(double way_m, double side_slip_rad, double turned_rad);
  // To the left of the path and of its heading, at each of the distances; the last values where it did not
  // come there.
  void finish(std::vector<float>& drift_m, std::vector<float>& turned_rad);

 private:
  const std::vector<double>& wanted_m_;
  std::vector<float> drifts_m_, turns_rad_;
  double come_m_ = 0.0, drift_m_ = 0.0, turned_rad_ = 0.0;
};

}  // namespace slipway::sim
