#pragma once

#include <string>
#include <string_view>

namespace slipway::steps {

// A file in memory. What kind of kernel it is, is told by its content.
struct KernelBytes {
  std::string name;
  std::string_view bytes;
};

}  // namespace slipway::steps
