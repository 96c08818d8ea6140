#include <fmt/format.h>

#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "api/json/writer.h"
#include "server/cli/terminal/tables.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {
namespace {

using api::json::at;
using api::json::has;
using api::json::JsonValue;
using api::json::number;
using api::json::text;

std::string value_words(const JsonValue& figure) {
  if (figure.is(JsonValue::Kind::kNull)) return "-";
  if (!figure.is(JsonValue::Kind::kObject)) return fmt::format("{:.4g}", figure.number);
  return fmt::format("{:.3g} ({:.3g} to {:.3g})", number(figure, "value"), number(figure, "low"),
                     number(figure, "high"));
}

std::string side_words(const JsonValue& side) {
  if (!side.is(JsonValue::Kind::kObject)) return "none";
  return has(side, "rank") ? fmt::format("route {:.0f}", number(side, "rank")) : "the drive";
}

// A value of a request on one line, cut where it is long.
std::string request_words(const JsonValue& value) {
  constexpr std::size_t kMost = 60;
  api::json::Writer w;
  write_value(w, value);
  std::string words = w.take();
  return words.size() > kMost ? words.substr(0, kMost) + "..." : words;
}

std::string routes_table(const JsonValue& pair) {
  const JsonValue &a = at(pair, "a"), &b = at(pair, "b");
  TextTable table({"", "a: " + side_words(a), "b: " + side_words(b), "b less a"});
  table.add({"verdict", text(a, "verdict"), text(b, "verdict"), ""});
  const JsonValue& shown = a.is(JsonValue::Kind::kObject) ? a : b;
  for (const std::string& key : shown.keys) {
    if (key == "rank" || key == "verdict") continue;
    std::string difference;
    for (const JsonValue& row : at(pair, "differences").elements)
      if (text(row, "figure") == key)
        difference = fmt::format("{:+.3g}{}", number(row, "b_less_a"),
                                 at(row, "intervals_apart").boolean ? ", intervals apart" : "");
    table.add({key, value_words(at(a, key)), value_words(at(b, key)), difference});
  }
  std::string out = table.print();
  if (has(pair, "apart_m"))
    out += fmt::format("The two are {:.1f} m apart on average\n", number(pair, "apart_m"));
  return out;
}

}  // namespace

Result<std::string> answer_comparison_table(std::string_view comparison) {
  const auto document =
      api::json::parse(comparison, {.bytes = comparison.size(), .values = comparison.size()});
  if (!document) return fail(document.error());
  std::string out;
  const JsonValue& changes = at(*document, "changed_in_request");
  if (changes.elements.empty()) out += "The requests are the same\n";
  for (const JsonValue& change : changes.elements)
    out += fmt::format("Request {}: a {}, b {}\n", text(change, "key"), request_words(at(change, "a")),
                       request_words(at(change, "b")));
  for (const JsonValue& pair : at(*document, "routes").elements) out += "\n" + routes_table(pair);
  return out;
}

}  // namespace slipway::server
