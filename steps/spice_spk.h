#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/result.h"
#include "steps/spice_daf.h"

// Positions, by NAIF's "SPK Required Reading": types 8 (Lagrange, equal steps), 9 (Lagrange) and 13 (Hermite)
// hold states and their times. The states alone are read: between them nothing is known of a rover.
namespace slipway::steps {

struct SpkState {
  double et_s = 0.0;  // TDB seconds past J2000
  std::array<double, 3> position_m{};
};

struct SpkSegment {
  std::string name;
  int target = 0, centre = 0, frame = 0;
  double start_et_s = 0.0, end_et_s = 0.0;
  std::vector<SpkState> states;  // in file order; times never decrease
};

// The types of segment that read_spk_segment() knows.
bool is_readable_spk(const DafArray& array);

// Errors: unreadable_data with the byte of a wrong count, of a number that is not finite, or of a time that
// is before the last one.
Result<SpkSegment> read_spk_segment(const DafFile& daf, const DafArray& array);

}  // namespace slipway::steps
