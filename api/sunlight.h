#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "api/files/terrain_site.h"
#include "core/result.h"
#include "dem/grid_geometry.h"
#include "dem/horizon.h"
#include "dem/write/rgba_image.h"
#include "sky/bearing.h"

// Where the ground lies in the sun.
namespace slipway::api {

inline constexpr dem::Rgba kShadow{0x10, 0x14, 0x30, 0xb4};
// The share of the suns that light a place is below these: dark blue to yellow [cividis].
struct SunlitClass {
  double below = 0.0;
  dem::Rgba colour;
};
inline constexpr std::array<SunlitClass, 5> kSunlitClasses{{{0.25, {0x00, 0x22, 0x4e, 0xb4}},
                                                            {0.5, {0x41, 0x4d, 0x6b, 0xb4}},
                                                            {0.75, {0x7d, 0x7c, 0x78, 0xb4}},
                                                            {0.9, {0xbc, 0xae, 0x6c, 0xb4}},
                                                            {1.0, {0xfe, 0xe8, 0x38, 0xb4}}}};
constexpr std::size_t kMostSuns = 100;

// The horizon of the ground of an extent in cells that are fine enough for its picture, and beyond it of the
// whole terrain in coarser ones: what lies outside casts shadows into it. Errors: those of
// TerrainSite::read_samples.
Result<std::shared_ptr<const dem::Horizon>> horizon_of(const TerrainSite& site, const dem::Extent& extent);

// A picture of the extent under suns whose azimuths count from the map's north. Under one: shadow, and
// transparent where the ground is lit; under several: in which share of them it is. Transparent where the
// terrain has no height. The ground is lit where the sun stands over the level and over the ground's horizon.
dem::RgbaImage draw_sunlight(const dem::Horizon& horizon, const dem::Extent& extent,
                             const std::vector<sky::Bearing>& suns);

}  // namespace slipway::api
