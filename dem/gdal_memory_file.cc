#include "dem/gdal_memory_file.h"

#include <cpl_vsi.h>
#include <fmt/format.h>

#include <atomic>
#include <memory>

namespace slipway::dem {
namespace {

struct VsiFree {
  void operator()(GByte* bytes) const { VSIFree(bytes); }
};

std::string new_name(std::string_view ending) {
  static std::atomic<unsigned long long> count{0};
  return fmt::format("/vsimem/slipway-{}{}", count++, ending);
}

}  // namespace

GdalMemoryFile::GdalMemoryFile(std::string_view ending) : name_(new_name(ending)) {}

std::optional<std::string> GdalMemoryFile::take() {
  vsi_l_offset size = 0;
  const std::unique_ptr<GByte, VsiFree> bytes(VSIGetMemFileBuffer(name_.c_str(), &size, TRUE));
  if (!bytes) return std::nullopt;
  return std::string(reinterpret_cast<const char*>(bytes.get()), static_cast<std::size_t>(size));
}

}  // namespace slipway::dem
