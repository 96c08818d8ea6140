#pragma once

#include <algorithm>
#include <string>

#include "gap/diagnosis/decide/search_record.h"

namespace slipway::gap {

// Whether an explanation stands before what was believed and before drives that it was not fitted to.
//
// It may contradict what was believed before the drives: a prior-data conflict [Box 1980; Evans and Moshonov
// 2006]. D^2 adds up how far each re-tuned parameter and each scale of the drives' scatter (above what was
// believed) lies from its belief, in deviations, squared; parameters with an end nearby, which may lie there,
// are left out. Under the beliefs D^2 is chi-square with as many degrees of freedom at most.
//
// And it may leave more over on drives that were held out of it than their noise does. Readings of a window
// share what it scatters by, so that a window counts as one: of n windows, n times the mean square of the
// held-out residuals in deviations, r^2, is chi-square with n degrees of freedom. The equations of its
// effects may be off by a share of what they close of the gap (DiscrepancyOptions::form_imprecision), so that
// r^2 / (1 + (share (r of nothing - r))^2) takes its place.
struct Adequacy {
  double conflict_p = 1.0;    // that beliefs like these give as large a D^2
  std::string furthest;       // the parameter that lies furthest off; empty: it is a scale of the scatter
  double deviations = 0.0;    // how far
  double held_out_rms = 0.0;  // of drives held out of it, in deviations of the noise
  double held_out_p = 1.0;    // that the noise leaves as much over

  double p() const { return std::min(conflict_p, held_out_p); }
};
Adequacy adequacy_of(const SearchRecord& record, std::size_t fit);

}  // namespace slipway::gap
