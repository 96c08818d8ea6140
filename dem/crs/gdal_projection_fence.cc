#include "dem/crs/gdal_projection_fence.h"

#include <dlfcn.h>
#include <proj.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace slipway::dem {
namespace {

namespace fs = std::filesystem;

// The canonical folder of PROJ's database; empty for none.
const fs::path& own_folder() {
  static const auto& folder = *new fs::path([] {
    const char* const database = proj_context_get_database_path(nullptr);
    std::error_code ignored;
    return database == nullptr ? fs::path() : fs::weakly_canonical(database, ignored).parent_path();
  }());
  return folder;
}

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

}  // namespace

void raise_projection_fence() {
  own_folder();
  proj_context_set_fileapi(nullptr, &kAdmittedFiles, nullptr);
}

}  // namespace slipway::dem

// Stands before PROJ's own, for GDAL and for PROJ itself, which makes contexts that nobody else sees while it
// reads WKT: no context inherits its file access from another. Whoever links PROJ statically is told by the
// linker that this can't be.
extern "C" PJ_CONTEXT* proj_context_create() {
  using Create = PJ_CONTEXT* (*)();
  static const auto create = reinterpret_cast<Create>(::dlsym(RTLD_NEXT, "proj_context_create"));
  if (create == nullptr) return nullptr;
  slipway::dem::own_folder();  // is asked for before any file is
  PJ_CONTEXT* const context = create();
  if (context != nullptr) proj_context_set_fileapi(context, &slipway::dem::kAdmittedFiles, nullptr);
  return context;
}
