#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

// What clients send: files, and the drive campaigns and terrains that are made of them.
namespace slipway::api {

// Who asks for work: what is made of it is theirs.
struct Asker {
  std::string name = {};  // of the token; empty: anybody, where none are needed
  bool is_admin = false;
};

// Who put something there, and when.
struct UploadOrigin {
  std::string owner = {};    // empty: anybody's
  std::int64_t at_ms = 0;    // since 1970
  std::string from = {};     // of a campaign or terrain: the upload that it is made of
  std::string follows = {};  // of a campaign: the one that drives were appended to
};

// A file that a client sent.
struct Upload {
  std::string id;      // SHA-256 of its bytes, 64 hexadecimal digits
  std::string folder;  // its name in files()
  std::string name;    // as the client calls it: letters, digits, ".", "_", "-"
  std::int64_t bytes = 0;
  UploadOrigin origin;
};

struct UploadLimits {
  std::int64_t max_total_bytes = std::int64_t{64} << 30;         // of the whole folder
  std::int64_t max_age_ms = std::int64_t{7} * 24 * 3600 * 1000;  // of files: what is made of them stays
};

// A folder of uploads: files/ID.OWNER, drive-campaigns/ID, terrains/NAME. Everything in it is under its name
// only when it is whole. Several processes may use it at once. Thread-safe.
class UploadFolder {
 public:
  // Makes the folder where there is none. Errors: unwritable_file.
  static Result<std::shared_ptr<UploadFolder>> open(const std::filesystem::path& root,
                                                    UploadLimits limits = {});

  const std::filesystem::path& root() const { return root_; }
  std::filesystem::path files() const { return root_ / "files"; }
  std::filesystem::path campaigns() const { return root_ / "drive-campaigns"; }
  std::filesystem::path terrains() const { return root_ / "terrains"; }

  // Keeps the bytes of an open file in files(), without a name or with one that begins with a dot. The same
  // bytes a second time from the same owner are the upload of the first; each owner has an upload of them,
  // and the bytes are on the disk once. Files that are too old go. Errors: invalid_request at /name; storage,
  // storage_full.
  Result<Upload> keep(int fd, const std::string& name, const UploadOrigin& origin);
  // Sorted by id. What can't be read is left out. Of several uploads of the same bytes the asker's own stands
  // for all, or else the one that is anybody's, or else the first.
  std::vector<Upload> list(const Asker& asker = {}) const;
  std::optional<Upload> find(std::string_view id, const Asker& asker = {}) const;
  // The file's place, where its bytes still are what was sent. Errors: not_found, damaged_store.
  Result<std::filesystem::path> verified(const std::string& id, const Asker& asker = {}) const;
  // The upload alone: others of the same bytes stay. Whether it was there. Errors: storage.
  Result<bool> remove(const Upload& upload);

  // Bytes of all that is in the folder, of a file with several names once. Bodies that are still coming are
  // not in it.
  std::int64_t bytes() const;
  // How many bytes more it may hold, and its disk can.
  std::int64_t room() const;
  // Errors: storage_full where so many more are not allowed.
  Result<void> check_room(std::int64_t more) const;

 private:
  UploadFolder(std::filesystem::path root, UploadLimits limits) : root_(std::move(root)), limits_(limits) {}
  std::vector<Upload> all() const;
  void remove_old(std::int64_t now_ms);

  std::filesystem::path root_;
  UploadLimits limits_;
};

// The file that says where a folder of the uploads comes from. Nothing where there is none.
inline constexpr std::string_view kOriginFile = "upload.json";
std::string origin_document(const UploadOrigin& origin, std::string_view name);
Result<void> write_origin(const std::filesystem::path& folder, const UploadOrigin& origin,
                          std::string_view name);
std::optional<UploadOrigin> read_origin(const std::filesystem::path& folder, std::string* name = nullptr);

// Whether what is from there may be replaced or removed: by who made it, by anybody where nobody has, by an
// administrator, and where no tokens are needed. Where it is not known who made it (nothing), not by others.
bool may_change(const std::optional<UploadOrigin>& origin, const Asker& asker);

// Puts a finished folder under its name, so that it is there after a failure of power too. False: the name is
// taken. Errors: storage.
Result<bool> put_in_place(const std::filesystem::path& finished, const std::filesystem::path& place);
// Takes a folder away: it is gone under its name at once, then its bytes are. False: there was none.
Result<bool> take_away(const std::filesystem::path& place);

}  // namespace slipway::api
