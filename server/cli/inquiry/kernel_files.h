#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "steps/kernel_bytes.h"
#include "steps/kernel_sky.h"

namespace slipway::server {

// Files of SPICE kernels in memory.
class KernelFiles {
 public:
  // Errors: unreadable_data with every file that can't be read or is larger than 512 MiB.
  static Result<KernelFiles> read(const std::vector<std::string>& paths);

  // Under the files' own names, without their folders; they point into this object.
  std::vector<steps::KernelBytes> kernels() const;

 private:
  std::vector<std::string> names_, bytes_;
};

// Sun and Earth out of such files over "Mars" or "Moon". Errors: of KernelFiles::read(); of
// steps::KernelSky::read().
Result<steps::KernelSky> read_kernel_sky(const std::vector<std::string>& paths, std::string_view body);

// Whether a path is a file that begins as a kernel does. A pipe is not looked into.
bool is_kernel_file(const std::string& path);

}  // namespace slipway::server
