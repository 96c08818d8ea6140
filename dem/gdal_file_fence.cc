#include "dem/gdal_file_fence.h"

#include <cpl_conv.h>
#include <cpl_http.h>
#include <cpl_string.h>
#include <cpl_vsi_virtual.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <string_view>
#include <vector>

namespace slipway::dem {
namespace {

namespace fs = std::filesystem;

// The canonical folders that this thread may read and may write; empty for none.
thread_local fs::path admitted_folder;
thread_local fs::path writable_folder;

bool is_within(const fs::path& folder, const char* name) {
  if (folder.empty()) return false;
  std::error_code ignored;
  const fs::path path = fs::weakly_canonical(name, ignored);
  if (ignored) return false;
  const auto parted = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return parted.first == folder.end();
}

bool writable(const char* name) {
  return is_within(writable_folder, name);
}

bool admitted(const char* name) {
  return is_within(admitted_folder, name) || writable(name);
}

class RefusingFiles : public VSIFilesystemHandler {
 public:
  using VSIFilesystemHandler::Open;
  VSIVirtualHandle* Open(const char* /*name*/, const char* /*access*/, bool /*set_error*/,
                         CSLConstList /*options*/) override {
    errno = EACCES;
    return nullptr;
  }
  int Stat(const char* /*name*/, VSIStatBufL* /*status*/, int /*flags*/) override {
    errno = EACCES;
    return -1;
  }
  // The base class would open a URL-like handle of its own for these.
  VSIDIR* OpenDir(const char* /*path*/, int /*depth*/, const char* const* /*options*/) override {
    return nullptr;
  }
};

// Plain files. Whatever is not overridden here (listing, making folders, renaming) is refused by the base
// class.
class AdmittedFiles final : public RefusingFiles {
 public:
  explicit AdmittedFiles(VSIFilesystemHandler& plain) : plain_(plain) {}

  using VSIFilesystemHandler::Open;
  VSIVirtualHandle* Open(const char* name, const char* access, bool set_error,
                         CSLConstList options) override {
    const std::string_view mode(access);
    const bool reads = mode.find_first_of("wa+") == std::string_view::npos;
    if (reads ? admitted(name) : writable(name)) return plain_.Open(name, access, set_error, options);
    return RefusingFiles::Open(name, access, set_error, options);
  }
  int Stat(const char* name, VSIStatBufL* status, int flags) override {
    return admitted(name) ? plain_.Stat(name, status, flags) : RefusingFiles::Stat(name, status, flags);
  }
  int Unlink(const char* name) override { return writable(name) ? plain_.Unlink(name) : -1; }

 private:
  VSIFilesystemHandler& plain_;
};

// Null would mean "not mine" and hand the request to GDAL's own client: a refusal is an answer with an error
// in it.
CPLHTTPResult* refuse_request(const char* /*url*/, CSLConstList /*options*/, GDALProgressFunc /*progress*/,
                              void* /*progress_data*/, CPLHTTPFetchWriteFunc /*write*/, void* /*write_data*/,
                              void* /*user_data*/) {
  auto* answer = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
  answer->nStatus = -1;
  answer->pszErrBuf = CPLStrdup("network requests are refused");
  return answer;
}

}  // namespace

void raise_file_fence() {
  // Replaced and replacing handlers stay reachable to the end of the process: files may be open in the
  // former, and GDAL itself deletes the latter.
  static auto& kept = *new std::vector<VSIFilesystemHandler*>;
  if (!kept.empty()) return;

  kept.push_back(VSIFileManager::GetHandler("a plain file"));
  kept.push_back(new AdmittedFiles(*kept.front()));
  VSIFileManager::InstallHandler("", kept.back());

  VSIFilesystemHandler* refusing = kept.emplace_back(new RefusingFiles);
  const auto refuse = [refusing](const std::string& prefix) {
    kept.push_back(VSIFileManager::GetHandler(prefix.c_str()));
    VSIFileManager::InstallHandler(prefix, refusing);
  };
  const CPLStringList prefixes(VSIFileManager::GetPrefixes(), TRUE);
  for (int i = 0; i < prefixes.Count(); ++i) {
    const std::string prefix(prefixes[i]);
    if (prefix != "/vsimem/") refuse(prefix);
  }
  refuse("/vsicurl?");  // an alias that GetPrefixes() leaves out

  CPLHTTPSetFetchCallback(refuse_request, nullptr);
  OSRSetPROJEnableNetwork(0);
}

FolderAdmission::FolderAdmission(const fs::path& file) {
  std::error_code ignored;
  admitted_folder = fs::weakly_canonical(file, ignored).parent_path();
}

FolderAdmission::~FolderAdmission() {
  admitted_folder.clear();
}

WritingAdmission::WritingAdmission(const fs::path& folder) {
  std::error_code ignored;
  writable_folder = fs::weakly_canonical(folder, ignored);
}

WritingAdmission::~WritingAdmission() {
  writable_folder.clear();
}

}  // namespace slipway::dem
