#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/json/json_value.h"
#include "core/result.h"
#include "server/cli/inquiry/drive_options.h"

namespace slipway::server {

// A file of commands for a check, as slipway plan --commands writes it: the request of a check (JSON), or a
// table (see api/files/commands_csv.h).
class CommandsFile {
 public:
  // Errors: malformed_json, invalid_request with every fault and its place in the file.
  static Result<CommandsFile> read(std::string bytes, std::string name);

  // The file says it itself: "terrain", "rover".
  bool names(std::string_view key) const { return request_.find(key) != nullptr; }
  // What it says of the terrain and where the drive starts: "start", or the first place of "path". Empty
  // where it says neither, or not so that the request would be taken.
  std::string terrain() const;
  std::optional<PlaceOption> start() const;
  // The request of the check, with another's members laid over it.
  std::string request_with(const std::string& given) const;
  // An error of that request: each fault that is the file's has its line and column there.
  Error placed(Error error, const std::string& given) const;

 private:
  std::string place(const std::string& pointer) const;

  std::string bytes_, name_;
  api::json::JsonValue request_;
  std::vector<std::size_t> lines_;  // of a table's commands
};

}  // namespace slipway::server
