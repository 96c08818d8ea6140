#pragma once

#include <functional>

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
  // The share by place, where it is not the same everywhere: at most rock_share, which is used without it.
  // Called from several threads.
  std::function<double(double x_m, double y_m)> rock_share_at = {};
};

}  // namespace slipway::sim
