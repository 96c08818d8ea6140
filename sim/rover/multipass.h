#pragma once

#include <Eigen/Core>

#include "sim/rover/rover_model.h"
#include "sim/wheel/per_wheel.h"

namespace slipway::sim {

// Whose tracks the wheels drive in. Row k, column m: the share of wheel k's width on ground over which wheel
// m was the last to drive before it. The sum of a row is the share of the wheel's width that is not on fresh
// soil.
using TrackShares = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxWheels, kMaxWheels>;

// `velocity` is that of B in frame B, in any unit of speed, and `yaw_rate` goes with it (rad for a metre in
// that unit): tracks are the lines of the wheels' places in steady motion, straight ones or circles about the
// centre of the turn. Where a rover slides aside its tracks lie apart. A rover without velocity (at rest, or
// turning in place, where no wheel follows another for long) has none. Continuous in the motion, but for
// circles so tight that wheels stand half a turn apart on them, and for the step from the tightest circle to
// a turn in place.
TrackShares tracks_followed(const RoverModel& rover, const Eigen::Vector2d& velocity, double yaw_rate);

// The share of a rut's depth that is still there for the wheel that drives in it.
//
// A track is (1 + s) as stiff as fresh soil. Unloading and reloading go along the stiff curve, and the reload
// passes through the pressure at which the leader left it (return-point memory):
//
//   k z_u^n = (1 + s) k (z_u - z_r)^n   =>   z_r = z_u (1 - (1 + s)^(-1 / n))
//
//   z_u  depth of the leader's rut under load, m       s  stiffening by the first pass
//   z_r  depth of the rebounded rut, m                 n  exponent of sinkage
//
// s = 0: soil without memory, the rut closes and every wheel meets fresh soil. s -> infinity: the rut stays
// as it was made. In (0, 1) between, rising with s.
double rut_share(double stiffening, double n);

// Depth below the undisturbed surface of every wheel: its own sinkage and the depth of the rebounded ruts in
// which it drives, by their shares. Linear in the own sinkages:
//
//   z_k = own_k + rut_share_k sum_m shares_km z_m
PerWheel<double> total_sinkages_m(const TrackShares& shares, const PerWheel<double>& rut_shares,
                                  const PerWheel<double>& own_sinkage_m);

}  // namespace slipway::sim
