#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/result.h"
#include "steps/spice_daf.h"

// Positions, by NAIF's "SPK Required Reading". Types 8 (Lagrange, equal steps), 9 (Lagrange) and 13 (Hermite)
// hold states and their times. The states alone are read: between them nothing is known of a rover. Types 2
// and 3 hold Chebyshev polynomials, as those of planets and moons do, and are known at any time.
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

// The types of segment that read_spk_segment() knows: 8, 9 and 13.
bool is_readable_spk(const DafArray& array);

// Errors: unreadable_data with the byte of a wrong count, of a number that is not finite, or of a time that
// is before the last one.
Result<SpkSegment> read_spk_segment(const DafFile& daf, const DafArray& array);

// Of one body from another.
struct SpkMotion {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero(), velocity_m_s = Eigen::Vector3d::Zero();
};

// A segment of type 2 or 3: in intervals of equal length each coordinate is a sum of Chebyshev polynomials.
// The velocity is the position's derivative; polynomials of its own, which type 3 has, are not looked at.
struct SpkPolynomials {
  std::string name;
  int target = 0, centre = 0, frame = 0;
  double start_et_s = 0.0, end_et_s = 0.0;         // within the intervals
  double first_et_s = 0.0, interval_s = 1.0;       // where the first interval begins, and how long each is
  std::size_t record_words = 0, coefficients = 0;  // of an interval, and of a coordinate
  std::vector<double> words;  // intervals by rising time: middle, half length, x, y, z [km]

  // At a time from start_et_s to end_et_s. Where two intervals meet the later one says.
  SpkMotion at(double et_s) const;
};

// The types of segment that read_spk_polynomials() knows: 2 and 3.
bool has_polynomials(const DafArray& array);

// Errors: unreadable_data with the byte of a wrong count or length, of a number that is not finite or beyond
// the solar system, or of an interval that is not where the segment says.
Result<SpkPolynomials> read_spk_polynomials(const DafFile& daf, const DafArray& array);

}  // namespace slipway::steps
