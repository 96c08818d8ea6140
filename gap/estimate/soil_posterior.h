#pragma once

#include <span>

#include "gap/estimate/least_squares.h"
#include "gap/estimate/soil_parameter.h"
#include "sim/soil/soil.h"

namespace slipway::gap {

// A distribution's spread along an axis, of the axis's coordinate: the inverse of what posterior_soil does. 0
// where it gives none.
double coordinate_std(const sim::SoilDistribution& soil, SoilParameter axis, const SoilAxes& axes);

// What is believed of the soil after a fit over `axes`, whose places among the fit's unknowns are given: the
// fitted soil as the mean, with spread and correlation of what was searched; of what was not, and of what
// neither data nor priors say anything of, the nominal soil's. What a soil's file can't hold is cut to it and
// said in `assumed`.
sim::SoilDistribution posterior_soil(const sim::SoilDistribution& nominal, const sim::Soil& fitted,
                                     const SoilAxes& axes, std::span<const std::size_t> places,
                                     const LeastSquaresFit& fit);

}  // namespace slipway::gap
