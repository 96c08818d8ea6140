#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/rover/ground.h"

namespace slipway::sim {

// How far the ground under a wheel may be from the map: heights of the map that are wrong, shapes that are
// smaller than its cells, and rocks. Nothing of it at the initial values.
struct ReliefSpread {
  double elevation_error_m = 0.0;  // standard deviation of the map's heights
  double error_length_m = 5.0;     // over which the error changes
  double roughness_m = 0.0;        // standard deviation of heights about the map's surface
  double roughness_length_m = 0.5;
  // Share of the ground that rocks cover, k in the cumulative fractional area of rocks at least as wide as D,
  //
  //   F(D) = k exp(-q D),  q = 1.79 + 0.152 / k      [Golombek & Rapp 1997; Golombek et al. 2003, eq. 1 and
  //   2]
  //
  // D in metres. Rocks from min to max are drawn; a rock stands half as high as it is wide.
  double rock_share = 0.0;
  double min_rock_m = 0.1;
  double max_rock_m = 0.5;  // drivers go round what is wider
};

// How many rocks at least as wide as D there are on a square metre, up to the widest that is drawn: the
// integral of -dF/dD / (pi D^2 / 4). 0 without rocks.
double rocks_per_m2(const ReliefSpread& spread, double min_width_m);

// One draw of the relief on a ground: a function of the key and the place, as DrawnGround is. The errors are
// normal numbers at the corners of a lattice, blended smoothly with a variance of one everywhere; rocks are a
// Poisson process. The ground must outlive it; used from several threads.
class DrawnRelief final : public Ground {
 public:
  DrawnRelief(const Ground& ground, const ReliefSpread& spread, std::uint64_t key);

  std::optional<GroundPoint> at(double x_m, double y_m) const override;
  std::optional<std::size_t> soil_at(double x_m, double y_m) const override;

 private:
  struct Rise {
    double height_m = 0.0, by_x = 0.0, by_y = 0.0;  // and its gradient
  };
  static Rise noise(std::uint64_t key, double deviation_m, double length_m, double x_m, double y_m);
  Rise rocks(double x_m, double y_m) const;

  const Ground& ground_;
  ReliefSpread spread_;
  std::uint64_t key_;
  // Widths at which equal shares of the rocks are wider, from the widest to the least wide.
  std::vector<double> widths_m_;
  double rocks_per_m2_ = 0.0;
};

}  // namespace slipway::sim
