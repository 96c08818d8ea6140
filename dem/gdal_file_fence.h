#pragma once

#include <filesystem>

namespace slipway::dem {

// Limits the files that GDAL may open. A raster can refer to other files and addresses (external overviews,
// detached labels, layered formats, a CRS by URL), and GDAL would follow. Once the fence is raised, in this
// whole process:
//   - plain files open for reading only, and only those in the folder that the calling thread has been
//   admitted to; for writing, those in the one folder of its WritingAdmission;
//   - every /vsi file system but /vsimem/ is refused: archives, sub-files, standard input, the network;
//   - GDAL's own HTTP requests and PROJ's grid downloads are refused.
void raise_file_fence();

// Admits the calling thread to the folder that holds `file` for the life of this object. Without one, a
// thread is admitted to no folder.
class FolderAdmission {
 public:
  explicit FolderAdmission(const std::filesystem::path& file);
  ~FolderAdmission();
  FolderAdmission(const FolderAdmission&) = delete;
  FolderAdmission& operator=(const FolderAdmission&) = delete;
};

// Admits the calling thread to read, write and remove files in one folder for the life of this object.
class WritingAdmission {
 public:
  explicit WritingAdmission(const std::filesystem::path& folder);
  ~WritingAdmission();
  WritingAdmission(const WritingAdmission&) = delete;
  WritingAdmission& operator=(const WritingAdmission&) = delete;
};

}  // namespace slipway::dem
