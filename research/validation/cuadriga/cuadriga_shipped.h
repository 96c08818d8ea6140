#pragma once

#include <string>
#include <vector>

#include "api/files/catalogue.h"
#include "research/validation/cuadriga/cuadriga_fit.h"

namespace slipway::validation {

// The maximum differences between the table and solved stations, midway between the table's nodes.
struct TableError {
  double slip_straight = 0.0, current_straight_a = 0.0;
  double slip_turning = 0.0, current_turning_a = 0.0;
  double fastest_turn_deg_s = 0.0;  // among those of the last two
};
TableError table_error(const sim::RoverModel& rover, const CuadrigaParameters& parameters);

// Sentences on the estimates with their standard errors, on what the data do not determine, and on
// assumptions.
std::vector<std::string> fit_words(const CuadrigaFit& fit);

// The maximum relative difference between the shipped soil uma_rescue_area and motors of cuadriga, which are
// the fit's numbers rounded, and the fit. 1 where there is no such soil.
double shipped_difference(const api::Catalogue& catalogue, const CuadrigaParameters& parameters);

}  // namespace slipway::validation
