#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace slipway::dem {

// A file in GDAL's memory file system, into which a driver encodes a raster. Such files belong to the whole
// process, so that each object has a name of its own.
class GdalMemoryFile {
 public:
  // ending: ".tif", ".png".
  explicit GdalMemoryFile(std::string_view ending);

  const std::string& name() const { return name_; }
  // Removes the file and returns its bytes; empty where no driver has written it. The dataset must be closed
  // before.
  std::optional<std::string> take();

 private:
  std::string name_;
};

}  // namespace slipway::dem
