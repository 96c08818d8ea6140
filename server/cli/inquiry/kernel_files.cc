#include "server/cli/inquiry/kernel_files.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

namespace slipway::server {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxFileBytes = 512U << 20U;

}  // namespace

Result<KernelFiles> KernelFiles::read(const std::vector<std::string>& paths) {
  KernelFiles files;
  std::vector<Fault> faults;
  for (const std::string& path : paths) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    std::ifstream stream(path, std::ios::binary);
    if (error || !stream)
      faults.push_back({path, "there is no such file, or it can't be read"});
    else if (size > kMaxFileBytes)
      faults.push_back({path, fmt::format("{} bytes, must be {} at most", size, kMaxFileBytes)});
    else
      files.bytes_.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    files.names_.push_back(fs::path(path).filename().string());
  }
  if (!faults.empty())
    return fail(ErrorCode::kUnreadableData, "the SPICE kernels can't be read", std::move(faults));
  return files;
}

std::vector<steps::KernelBytes> KernelFiles::kernels() const {
  std::vector<steps::KernelBytes> kernels;
  for (std::size_t k = 0; k < bytes_.size(); ++k) kernels.push_back({names_[k], bytes_[k]});
  return kernels;
}

Result<steps::KernelSky> read_kernel_sky(const std::vector<std::string>& paths, std::string_view body) {
  const auto files = KernelFiles::read(paths);
  if (!files) return fail(files.error());
  return steps::KernelSky::read(files->kernels(), body);
}

bool is_kernel_file(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return false;
  std::array<char, 16> first{};
  std::ifstream stream(path, std::ios::binary);
  stream.read(first.data(), first.size());
  return steps::looks_like_kernel(std::string_view(first.data(), static_cast<std::size_t>(stream.gcount())));
}

}  // namespace slipway::server
