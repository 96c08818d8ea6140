#include "api/json/problem_document.h"

#include <algorithm>
#include <string>

#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "core/error_code.h"

namespace slipway::api::json {
namespace {

constexpr std::string_view kTypePrefix = "/errors#";

}  // namespace

std::string write_problem(const Error& unbounded) {
  const Error error = bounded(unbounded);
  const ErrorRow& row = error_row(error.code);
  Writer w;
  w.begin_object().text("type", std::string(kTypePrefix) + std::string(row.name)).text("title", row.help);
  w.whole("status", row.http_status).text("detail", error.detail).key("faults").begin_array();
  for (const Fault& fault : error.faults) {
    w.begin_object().text("pointer", fault.pointer).text("message", fault.message).end_object();
  }
  w.end_array().end_object();
  return w.take();
}

Error read_problem(std::string_view bytes) {
  Error error{ErrorCode::kInternal, "the stored failure can't be read", {}};
  const auto document = parse(bytes, {.bytes = bytes.size(), .values = bytes.size()});
  if (!document) return error;
  std::vector<Fault> ignored;
  ObjectReader reader(*document, "", ignored);
  std::string type;
  if (!reader.text("type", kRequired, {}, type) || !type.starts_with(kTypePrefix)) return error;
  const auto rows = error_table();
  const auto row = std::find_if(rows.begin(), rows.end(),
                                [&](const ErrorRow& r) { return r.name == type.substr(kTypePrefix.size()); });
  if (row == rows.end()) return error;
  error.code = row->code;
  const std::size_t most = bytes.size();
  reader.text("detail", kRequired, {.most = most, .may_be_empty = true}, error.detail);
  for (const Element& element : reader.list("faults", kRequired, {0, most})) {
    ObjectReader object(*element.value, element.pointer, ignored);
    Fault& fault = error.faults.emplace_back();
    object.text("pointer", kRequired, {.most = most, .may_be_empty = true}, fault.pointer);
    object.text("message", kRequired, {.most = most, .may_be_empty = true}, fault.message);
  }
  return error;
}

}  // namespace slipway::api::json
