#pragma once

#include <string>

#include "gap/diagnosis/decide/search_record.h"

namespace slipway::gap {

// Whether an explanation contradicts what was believed before the drives: a prior-data conflict [Box 1980;
// Evans and Moshonov 2006]. D^2 adds up how far each re-tuned parameter and each scale of the drives' scatter
// (above what was believed) lies from its belief, in deviations, squared; parameters with an end nearby,
// which may lie there, are left out. Under the beliefs D^2 is chi-square with as many degrees of freedom at
// most.
struct Adequacy {
  double conflict_p = 1.0;  // that beliefs like these give as large a D^2
  std::string furthest;     // the parameter that lies furthest off; empty: it is a scale of the scatter
  double deviations = 0.0;  // how far
};
Adequacy adequacy_of(const SearchRecord& record, std::size_t fit);

}  // namespace slipway::gap
