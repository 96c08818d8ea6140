#pragma once

#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "steps/spice_daf.h"
#include "steps/spice_spk.h"

namespace slipway::steps {

// Where bodies are, of the segments of several kernels with Chebyshev polynomials (SPK types 2 and 3) in the
// equator of J2000 (frame 1). Bodies have NAIF's numbers: 0 the barycentre of the solar system, 10 the sun,
// 301 the Moon, 399 the Earth.
class SpiceEphemeris {
 public:
  // The segments of these bodies, of what they are given from, and so on; no other is decoded. Where several
  // have a body at a time the last one of the last file says. Errors: of read_spk_polynomials(), of all
  // segments together.
  static Result<SpiceEphemeris> read(std::span<const DafFile> files, std::set<int> bodies);

  // Whether a segment has the body at any time.
  bool has(int body) const;
  // From the barycentre of the solar system, at TDB seconds past J2000. Errors: invalid_request with the body
  // that is missing and what the kernels have of it.
  Result<SpkMotion> motion(int body, double et_s) const;

 private:
  tl::unexpected<Error> missing(int body, double et_s) const;

  std::vector<SpkPolynomials> segments_;  // what says before what is behind it
  std::vector<DafArray> passed_over_;     // segments of wanted bodies, of other types or frames
  std::set<int> known_;                   // bodies of any segment
};

// "the Moon (body 301)".
std::string body_words(int body);

}  // namespace slipway::steps
