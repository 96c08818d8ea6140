#include "dem/gdal_import.h"

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_utils.h>

#include <algorithm>
#include <memory>

#include "dem/gdal_body_degrees.h"

namespace slipway::dem {
namespace {

constexpr int kLeastOverviewSide = 256;

struct FreeWarpOptions {
  void operator()(GDALWarpAppOptions* options) const { GDALWarpAppOptionsFree(options); }
};

tl::unexpected<Error> unwritable(const std::filesystem::path& out, const std::string& why) {
  return fail(ErrorCode::kUnwritableFile,
              fmt::format("{} could not be written: {}", out.filename().string(), why));
}

}  // namespace

int CPL_STDCALL report_stage(double share, const char* /*message*/, void* stage) {
  const auto& told = *static_cast<StageProgress*>(stage);
  told.progress->report(told.stage, share);
  return told.progress->cancelled() ? FALSE : TRUE;
}

std::vector<std::string> tiled_creation(bool heights) {
  return {"TILED=YES",
          "BLOCKXSIZE=256",
          "BLOCKYSIZE=256",
          "COMPRESS=DEFLATE",
          heights ? "PREDICTOR=3" : "PREDICTOR=2",
          "BIGTIFF=IF_SAFER"};
}

Result<void> warp_raster(GDALDataset& source, const std::filesystem::path& out,
                         const std::vector<std::string>& options, const GdalSession& session,
                         Progress& progress, const char* stage) {
  CPLStringList words;
  for (const std::string& word : options) words.AddString(word.c_str());
  for (const std::string& word : warp_source(source)) words.AddString(word.c_str());
  words.AddString("-novshift");  // cells keep their numbers, whatever grids of geoids the machine has
  const std::unique_ptr<GDALWarpAppOptions, FreeWarpOptions> prepared(
      GDALWarpAppOptionsNew(words.List(), nullptr));
  if (!prepared) return unwritable(out, session.complaints());
  StageProgress told{&progress, stage};
  GDALWarpAppOptionsSetProgress(prepared.get(), &report_stage, &told);
  GDALDatasetH from = GDALDataset::ToHandle(&source);
  CPLErrorReset();
  int misused = FALSE;
  GDALDatasetUniquePtr made(
      GDALDataset::FromHandle(GDALWarp(out.c_str(), nullptr, 1, &from, prepared.get(), &misused)));
  const bool complete = made != nullptr;
  made.reset();
  if (!complete || CPLGetLastErrorType() >= CE_Failure) return unwritable(out, session.complaints());
  return {};
}

Result<void> add_overviews(const std::filesystem::path& path, const char* method, const GdalSession& session,
                           Progress& progress) {
  CPLErrorReset();
  GDALDatasetUniquePtr raster(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE,
                                                allowed_raster_drivers(), nullptr, nullptr));
  if (!raster) return unwritable(path, session.complaints());
  std::vector<int> levels;
  const int side = std::max(raster->GetRasterXSize(), raster->GetRasterYSize());
  for (int level = 2; side / level >= kLeastOverviewSide / 2 && level < (1 << 20); level *= 2)
    levels.push_back(level);
  StageProgress told{&progress, "making overviews"};
  const bool complete =
      levels.empty() || raster->BuildOverviews(method, static_cast<int>(levels.size()), levels.data(), 0,
                                               nullptr, &report_stage, &told) == CE_None;
  raster.reset();
  if (!complete || CPLGetLastErrorType() >= CE_Failure) return unwritable(path, session.complaints());
  return {};
}

Error import_error(const std::vector<RasterFault>& faults, const char* pointer) {
  const auto mendable = std::count_if(faults.begin(), faults.end(), [](const auto& f) { return f.mendable; });
  Error error{faults.front().code, "", {}};
  error.detail = fmt::format("{} reason{} why this map can't be used as it is", faults.size(),
                             faults.size() == 1 ? "" : "s");
  if (mendable == static_cast<std::ptrdiff_t>(faults.size()))
    error.detail += "; --fix mends all of it";
  else if (mendable > 0)
    error.detail += fmt::format("; --fix mends {} of them", mendable);
  for (const RasterFault& fault : faults)
    error.faults.push_back({pointer, fault.sentence + (fault.mendable ? " (--fix mends it.)" : "")});
  return error;
}

}  // namespace slipway::dem
