#pragma once

#include <cpl_error.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "dem/gdal_file_fence.h"

namespace slipway::dem {

// One operation on GDAL by one thread. The first one in the process registers the allowed drivers and raises
// the fences around files and projections. While it lives, GDAL's complaints are gathered here and nothing
// reaches stderr. Sessions on files must not be nested.
class GdalSession {
 public:
  // For work in memory: no file may be opened.
  GdalSession();
  // For work on this file and on other files in its folder.
  explicit GdalSession(const std::filesystem::path& file);
  ~GdalSession();
  GdalSession(const GdalSession&) = delete;
  GdalSession& operator=(const GdalSession&) = delete;

  // Everything GDAL complained of so far, joined by "; ", with folders taken out of file names.
  std::string complaints() const;

 private:
  static void CPL_STDCALL gather(CPLErr severity, CPLErrorNum number, const char* message);

  std::vector<std::string> complaints_;
  std::string folder_;
  std::unique_ptr<FolderAdmission> admission_;
};

// While it lives, rasters that this thread opens are read with what the file NAME.aux.xml beside them says,
// or without it.
class SidecarReading {
 public:
  explicit SidecarReading(bool reads);
  ~SidecarReading();
  SidecarReading(const SidecarReading&) = delete;
  SidecarReading& operator=(const SidecarReading&) = delete;
};

// The raster drivers a file may be read with, by GDAL's short names, ended by a null pointer.
const char* const* allowed_raster_drivers();

}  // namespace slipway::dem
