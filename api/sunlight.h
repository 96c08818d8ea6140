#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "api/files/terrain_site.h"
#include "core/result.h"
#include "dem/grid_geometry.h"
#include "dem/horizon/horizon_sweep.h"
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

// The ground of an extent in cells that are fine enough for its picture. Errors: those of
// TerrainSite::read_samples.
Result<std::shared_ptr<const dem::Terrain>> ground_of(const TerrainSite& site, const dem::Extent& extent);

// What casts shadows: ground that is looked at and, beyond it, coarser ground. Thread-safe.
class ShadowGround {
 public:
  ShadowGround(std::shared_ptr<const dem::Terrain> near, double body_radius_m,
               const std::shared_ptr<const dem::Terrain>& around = nullptr);
  // Of an extent with all of the terrain around it. Errors: as of ground_of().
  static Result<ShadowGround> read(const TerrainSite& site, const dem::Extent& extent);

  // A picture of the extent, 256 cells along its longer side or half as many under kMostSuns suns. Their
  // azimuths count from the map's north. Under one: shadow, and transparent where the ground is lit; under
  // several: in which share of them it is. Transparent where the terrain has no height. The ground is lit
  // where the sun stands over the level and over the ground's horizon.
  dem::RgbaImage draw(const dem::Extent& extent, const std::vector<sky::Bearing>& suns) const;

 private:
  std::shared_ptr<const dem::Terrain> near_;
  dem::HorizonSweep sweep_;
  std::optional<dem::HorizonSweep> around_;
};

}  // namespace slipway::api
