#include "dem/gdal_session.h"

#include <cpl_conv.h>
#include <fmt/ranges.h>
#include <gdal.h>
#include <gdal_frmts.h>

#include <algorithm>
#include <array>
#include <mutex>

#include "dem/crs/gdal_projection_fence.h"

namespace slipway::dem {
namespace {

// Memory for decoded blocks of all open rasters; it holds some rows of tiles of a large raster.
constexpr GIntBig kBlockCacheBytes = 128LL << 20;

// Formats in which planetary and field elevations are published. Left out on purpose: VRT and every other
// format that is a recipe over other files; JPEG 2000, in which nobody publishes heights, and whose GML box
// names URLs.
constexpr std::array<const char*, 9> kDrivers{"GTiff", "AAIGrid", "PDS4", "ISIS3", "ISIS2",
                                              "PDS",   "ENVI",    "EHdr", nullptr};

void prepare_process() {
  CPLSetErrorHandler(CPLQuietErrorHandler);
  CPLSetConfigOption("GDAL_PAM_ENABLED", "NO");  // no .aux.xml is written; see SidecarReading
  CPLSetConfigOption("GDAL_DISABLE_READDIR_ON_OPEN", "TRUE");
  CPLSetConfigOption("OGR_GEOMETRY_ACCEPT_UNCLOSED_RING", "YES");  // unclosed rings are found and named by us
  GDALSetCacheMax64(kBlockCacheBytes);
  raise_file_fence();
  raise_projection_fence();
  GDALRegister_GTiff();
  GDALRegister_AAIGrid();
  GDALRegister_PDS4();
  GDALRegister_ISIS3();
  GDALRegister_ISIS2();
  GDALRegister_PDS();
  GDALRegister_ENVI();
  GDALRegister_EHdr();
  GDALRegister_MEM();
  GDALRegister_PNG();
}

void prepare_process_once() {
  static std::once_flag once;
  std::call_once(once, prepare_process);
}

}  // namespace

GdalSession::GdalSession() {
  prepare_process_once();
  CPLPushErrorHandlerEx(gather, this);
}

GdalSession::GdalSession(const std::filesystem::path& file) : GdalSession() {
  std::error_code ignored;
  folder_ = std::filesystem::weakly_canonical(file, ignored).parent_path().string() + "/";
  admission_ = std::make_unique<FolderAdmission>(file);
}

GdalSession::~GdalSession() {
  CPLPopErrorHandler();
}

void CPL_STDCALL GdalSession::gather(CPLErr severity, CPLErrorNum /*number*/, const char* message) {
  // A damaged file can complain once a block; the first few say what is wrong.
  constexpr std::size_t kMax = 5;
  auto* session = static_cast<GdalSession*>(CPLGetErrorHandlerUserData());
  if (severity < CE_Warning || session->complaints_.size() >= kMax) return;
  std::string text(message);
  for (std::size_t at = text.find(session->folder_); !session->folder_.empty() && at != std::string::npos;
       at = text.find(session->folder_)) {
    text.erase(at, session->folder_.size());
  }
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (std::find(session->complaints_.begin(), session->complaints_.end(), text) ==
      session->complaints_.end()) {
    session->complaints_.push_back(std::move(text));
  }
}

std::string GdalSession::complaints() const {
  return fmt::format("{}", fmt::join(complaints_, "; "));
}

SidecarReading::SidecarReading(bool reads) {
  CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", reads ? "YES" : "NO");
}

SidecarReading::~SidecarReading() {
  CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", nullptr);
}

const char* const* allowed_raster_drivers() {
  return kDrivers.data();
}

}  // namespace slipway::dem
