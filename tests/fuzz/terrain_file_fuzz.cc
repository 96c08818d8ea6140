// The reader of terrain.json.

#include "api/files/terrain_file.h"
#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slipway;
  const auto terrain = api::json::read_terrain_file(fuzz::text_of(data, size));
  fuzz::require(terrain || !terrain.error().detail.empty(), "a refusal says why");
  // Its files are opened inside the terrain's own folder.
  if (terrain)
    fuzz::require(terrain->elevation_file.find('/') == std::string::npos, "a file's name is no path",
                  terrain->elevation_file);
  return 0;
}
