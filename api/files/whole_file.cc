#include "api/files/whole_file.h"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

namespace slipway::api {

namespace fs = std::filesystem;

Result<void> write_whole_file(const fs::path& path, const std::string& bytes) {
  const fs::path unfinished = path.string() + std::string(kUnfinished);
  {
    std::ofstream stream(unfinished, std::ios::binary);
    if (!(stream << bytes << std::flush))
      return fail(ErrorCode::kUnwritableFile, fmt::format("cannot write {}", path.string()));
  }
  std::error_code error;
  fs::rename(unfinished, path, error);
  if (error)
    return fail(ErrorCode::kUnwritableFile,
                fmt::format("cannot write {}: {}", path.string(), error.message()));
  return {};
}

Result<void> make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error)
    return fail(ErrorCode::kUnwritableFile,
                fmt::format("cannot make {}: {}", path.string(), error.message()));
  return {};
}

}  // namespace slipway::api
