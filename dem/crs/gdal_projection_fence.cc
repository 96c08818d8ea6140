#include "dem/crs/gdal_projection_fence.h"

#include <ogr_spatialref.h>
#include <ogr_srs_api.h>
#include <proj.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace slipway::dem {
namespace {

namespace fs = std::filesystem;

// The canonical folder of PROJ's database; empty for none.
fs::path& own_folder() {
  static auto& folder = *new fs::path;
  return folder;
}

thread_local bool is_fenced = false;

bool admitted(const char* name) {
  std::error_code ignored;
  const fs::path& folder = own_folder();
  const fs::path path = fs::weakly_canonical(name, ignored);
  return !ignored && !folder.empty() &&
         std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

std::FILE* stream(PROJ_FILE_HANDLE* handle) {
  return reinterpret_cast<std::FILE*>(handle);
}

PROJ_FILE_HANDLE* open_admitted(PJ_CONTEXT* /*context*/, const char* name, PROJ_OPEN_ACCESS access,
                                void* /*user*/) {
  if (access != PROJ_OPEN_ACCESS_READ_ONLY || !admitted(name)) return nullptr;
  return reinterpret_cast<PROJ_FILE_HANDLE*>(std::fopen(name, "rbe"));
}

std::size_t read(PJ_CONTEXT* /*context*/, PROJ_FILE_HANDLE* file, void* to, std::size_t bytes,
                 void* /*user*/) {
  return std::fread(to, 1, bytes, stream(file));
}

std::size_t refuse_write(PJ_CONTEXT* /*context*/, PROJ_FILE_HANDLE* /*file*/, const void* /*from*/,
                         std::size_t /*bytes*/, void* /*user*/) {
  return 0;
}

int seek(PJ_CONTEXT* /*context*/, PROJ_FILE_HANDLE* file, long long offset, int whence, void* /*user*/) {
  return ::fseeko(stream(file), offset, whence) == 0 ? 1 : 0;
}

unsigned long long tell(PJ_CONTEXT* /*context*/, PROJ_FILE_HANDLE* file, void* /*user*/) {
  return static_cast<unsigned long long>(::ftello(stream(file)));
}

void close(PJ_CONTEXT* /*context*/, PROJ_FILE_HANDLE* file, void* /*user*/) {
  std::fclose(stream(file));
}

int exists(PJ_CONTEXT* /*context*/, const char* name, void* /*user*/) {
  std::error_code ignored;
  return admitted(name) && fs::exists(name, ignored) ? 1 : 0;
}

int refuse_change(PJ_CONTEXT* /*context*/, const char* /*name*/, void* /*user*/) {
  return 0;
}

int refuse_rename(PJ_CONTEXT* /*context*/, const char* /*from*/, const char* /*to*/, void* /*user*/) {
  return 0;
}

constexpr int kVersionOfTable = 1;
constexpr PROJ_FILE_API kAdmittedFiles{
    kVersionOfTable, open_admitted, read,          refuse_write,  seek,         tell,
    close,           exists,        refuse_change, refuse_change, refuse_rename};

// A context inherits the default one's finder of files, though not its table of file access: the finder,
// which is asked for the database first, hands that on. It finds nothing by itself.
const char* fence_and_find(PJ_CONTEXT* context, const char* /*name*/, void* /*user*/) {
  is_fenced = proj_context_set_fileapi(context, &kAdmittedFiles, nullptr) != 0;
  return nullptr;
}

void ask_for_the_database() {
  constexpr int kAnySystem = 4326;
  OGRSpatialReference any;
  any.importFromEPSG(kAnySystem);
}

}  // namespace

void raise_projection_fence() {
  const char* const database = proj_context_get_database_path(nullptr);
  std::error_code ignored;
  if (database != nullptr) own_folder() = fs::weakly_canonical(database, ignored).parent_path();
  proj_context_set_fileapi(nullptr, &kAdmittedFiles, nullptr);
  proj_context_set_file_finder(nullptr, fence_and_find, nullptr);
}

void fence_projections_of_thread() {
  if (is_fenced) return;
  // A context from before the fence has no finder, and is made anew.
  OSRCleanup();
  ask_for_the_database();
}

}  // namespace slipway::dem
