#include "shipped_catalogue.h"

#include "fuzz_target.h"

namespace slipway::fuzz {

const api::Catalogue& shipped_catalogue() {
  static const Result<api::Catalogue> catalogue = api::load_catalogue(SLIPWAY_DATA_FOLDER);
  require(catalogue.has_value(), "the shipped data can be read", catalogue ? "" : catalogue.error().detail);
  return *catalogue;
}

}  // namespace slipway::fuzz
