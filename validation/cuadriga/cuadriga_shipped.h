#pragma once

#include <string>
#include <vector>

#include "api/files/catalogue.h"
#include "validation/cuadriga/cuadriga_fit.h"

namespace slipway::validation {

// How far the table is from solving each window, midway between its stations: largest differences.
struct TableError {
  double slip_straight = 0.0, current_straight_a = 0.0;
  double slip_turning = 0.0, current_turning_a = 0.0;
  double fastest_turn_deg_s = 0.0;  // among those of the last two
};
TableError table_error(const sim::RoverModel& rover, const CuadrigaParameters& parameters);

// What was estimated with its standard errors, what the data leave open, what was assumed.
std::vector<std::string> fit_words(const CuadrigaFit& fit);

// The largest relative difference of the soil uma_rescue_area and of the motors of cuadriga, as they are
// shipped, to the fit: they are its numbers, rounded. 1 where there is no such soil.
double shipped_difference(const api::Catalogue& catalogue, const CuadrigaParameters& parameters);

}  // namespace slipway::validation
