#include "dem/crs/gdal_named_crs.h"

#include <array>

#include "dem/crs/crs_text.h"

namespace slipway::dem {

std::unique_ptr<OGRSpatialReference> named_crs(const std::string& text) {
  constexpr std::array<const char*, 3> kHere{"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
  auto crs = std::make_unique<OGRSpatialReference>();
  if (fault_of_crs_text(text) || crs->SetFromUserInput(text.c_str(), kHere.data()) != OGRERR_NONE)
    return nullptr;
  return crs;
}

}  // namespace slipway::dem
