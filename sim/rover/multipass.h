#pragma once

#include "sim/rover/drive_command.h"
#include "sim/wheel/per_wheel.h"

namespace slipway::sim {

// For each wheel the index of the nearest wheel ahead of it whose track it drives in, or -1. A wheel's track
// is the line of its place when the rover moves as commanded: wheel k follows wheel m where their lines lie
// closer than half the sum of their widths: across the direction of travel on the straight and in crab
// motion, in the radii about the turn's centre on an arc. Turning in place no wheel follows another for long:
// none.
PerWheel<int> leaders(const RoverModel& rover, const DriveCommand& command);

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

// Depth below the undisturbed surface of every wheel: z_k = z_r(leader) + own sinkage into the rut's bottom.
// Linear in the own sinkages: z_k = own_k + share_k z_leader(k).
PerWheel<double> total_sinkages_m(const PerWheel<int>& leaders, const PerWheel<double>& rut_shares,
                                  const PerWheel<double>& own_sinkage_m);

}  // namespace slipway::sim
