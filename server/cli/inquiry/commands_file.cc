#include "server/cli/inquiry/commands_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "api/documents/drive_commands.h"
#include "api/json/laid_over.h"
#include "api/json/parse.h"
#include "api/json/text_place.h"

namespace slipway::server {
namespace {

using api::json::JsonValue;

// "/limits/max_slip" -> "limits"
std::string_view first_key(std::string_view pointer) {
  if (!pointer.starts_with('/')) return {};
  pointer.remove_prefix(1);
  return pointer.substr(0, pointer.find('/'));
}

// The value of a pointer whose keys have no escapes, as those of requests.
bool holds(const JsonValue& document, std::string_view pointer) {
  const JsonValue* at = &document;
  while (at != nullptr && pointer.starts_with('/')) {
    const std::string_view key = first_key(pointer);
    pointer.remove_prefix(key.size() + 1);
    at = at->find(key);
  }
  return at != nullptr;
}

bool is_table(std::string_view bytes, std::string_view name) {
  if (name.ends_with(".csv")) return true;
  return name == "-" &&
         !bytes.substr(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size())).starts_with('{');
}

}  // namespace

Result<CommandsFile> CommandsFile::read(std::string bytes, std::string name) {
  CommandsFile file;
  std::string request = bytes;
  if (is_table(bytes, name)) {
    auto table = api::read_commands_csv(bytes, name);
    if (!table) return fail(table.error());
    file.lines_ = table->lines;
    request = api::json::check_of_table(*table);
  }
  auto document = api::json::parse(request);
  if (!document) {
    Error error = document.error();
    error.detail = fmt::format("{}: {}", name, error.detail);
    return fail(std::move(error));
  }
  if (!document->is(JsonValue::Kind::kObject)) {
    const std::string why = fmt::format("{} must be an object, the request of a check", name);
    return fail(ErrorCode::kInvalidRequest, why, {{fmt::format("{}, line 1, column 1", name), why}});
  }
  file.request_ = *std::move(document);
  file.bytes_ = std::move(bytes);
  file.name_ = std::move(name);
  return file;
}

std::string CommandsFile::terrain() const {
  const JsonValue* const name = request_.find("terrain");
  return name != nullptr && name->is(JsonValue::Kind::kString) ? name->text : std::string();
}

std::optional<PlaceOption> CommandsFile::start() const {
  const JsonValue* at = request_.find("start");
  const JsonValue* const path = request_.find("path");
  if (at == nullptr && path != nullptr && !path->elements.empty()) at = &path->elements.front();
  if (at == nullptr) return std::nullopt;
  const JsonValue *const x = at->find("x_m"), *const y = at->find("y_m");
  if (x == nullptr || y == nullptr || !x->is(JsonValue::Kind::kNumber) || !y->is(JsonValue::Kind::kNumber))
    return std::nullopt;
  return PlaceOption{x->number, y->number, {}};
}

std::string CommandsFile::request_with(const std::string& given) const {
  return api::json::laid_over(request_, api::json::parse(given).value());
}

std::string CommandsFile::place(const std::string& pointer) const {
  constexpr std::string_view kCommands = "/commands/";
  if (lines_.empty()) {
    const api::json::TextPlace at = api::json::place_of(bytes_, pointer);
    return fmt::format("{}, line {}, column {} ({})", name_, at.line, at.column, pointer);
  }
  std::size_t row = 0;
  if (pointer.starts_with(kCommands)) {
    const char* const end = pointer.data() + pointer.size();
    std::from_chars(pointer.data() + kCommands.size(), end, row);
    if (row < lines_.size()) return fmt::format("{}, line {} ({})", name_, lines_[row], pointer);
  }
  return fmt::format("{} ({})", name_, pointer);
}

Error CommandsFile::placed(Error error, const std::string& given) const {
  const JsonValue over = api::json::parse(given).value();
  for (Fault& fault : error.faults)
    if (names(first_key(fault.pointer)) && !holds(over, fault.pointer)) fault.pointer = place(fault.pointer);
  return error;
}

}  // namespace slipway::server
