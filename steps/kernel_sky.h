#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "sky/orientation.h"
#include "sky/sky.h"
#include "steps/kernel_bytes.h"
#include "steps/spice_ephemeris.h"

// Sun and Earth over a place on Mars or the Moon, out of SPICE kernels. It stands in this room because the
// readers of kernels do; the sky itself knows no files.
namespace slipway::steps {

// A body's own place in the kernels and its shape.
struct KernelBody {
  std::string_view name;   // of dem::ElevationInfo
  int id, barycentre;      // what stands for it where kernels don't have it; 0: nothing
  double radius_m, polar;  // at the equator, and polar over equatorial
  std::int64_t step_ms;    // between moments of a table
};

struct SkyPlace {
  double east_longitude_rad = 0.0, latitude_rad = 0.0;  // planetocentric
};

class KernelSky {
 public:
  // Kernels in any order, told by their content: positions (SPK) of the body, the sun and the Earth, and
  // constants (text PCK) with its pole and prime meridian, of which the last one says; without them these are
  // those of sky/orientation.h. Leap seconds (LSK) are built in and not looked at. `body`: "Mars" or "Moon".
  // Errors: unreadable_data with the file and byte or line of all that is wrong; invalid_request for another
  // body.
  static Result<KernelSky> read(std::span<const KernelBytes> files, std::string_view body);

  // Where sun and Earth are seen: as the light left them, and shifted by the body's way about the sun
  // [Urban & Seidelmann 2013, chapter 7]. Elevations are over the level of the ellipsoid. The place is taken
  // to lie on it: of the Earth over the Moon a height of 10 km is 0.0015 deg. Errors: invalid_request with
  // the body and what the kernels have of it.
  Result<sky::SkySample> over(const SkyPlace& place, std::int64_t utc_ms) const;

  // Moments from one time to another, at most `most` of them, so near that between them directions are within
  // 0.004 deg: 5 minutes on Mars, an hour on the Moon. Behind `to_ms` it goes on until `beyond_ms`, as far as
  // the kernels and `most` reach. Errors: those of over() up to `to_ms`; invalid_request where that is more
  // than `most`.
  Result<std::vector<sky::SkySample>> table(const SkyPlace& place, std::int64_t from_ms, std::int64_t to_ms,
                                            std::int64_t beyond_ms, std::size_t most) const;

 private:
  KernelSky(const KernelBody& body, sky::Orientation orientation, SpiceEphemeris ephemeris);

  KernelBody body_;
  sky::Orientation orientation_;
  SpiceEphemeris ephemeris_;
};

// Whether a file with these first bytes is a kernel, binary or text.
bool looks_like_kernel(std::string_view bytes);

}  // namespace slipway::steps
