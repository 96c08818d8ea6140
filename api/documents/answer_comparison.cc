#include "api/documents/answer_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "api/documents/route_pairs.h"
#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "api/json/writer.h"

namespace slipway::api::json {
namespace {

constexpr std::array<std::string_view, 3> kFormats{"plan/1", "check/1", "prediction/1"};
constexpr std::array<std::string_view, 8> kFigures{"length_m",       "duration_s", "energy_wh", "mean_slip",
                                                   "expected_stops", "embedding",  "risk",      "cost"};

// A figure with its 90 % interval where it has one; nothing where it is not known.
struct Figure {
  double value = 0.0;
  bool has_interval = false;
  double low = 0.0, high = 0.0;
};

std::optional<Figure> figure_of(const JsonValue& value) {
  if (value.is(JsonValue::Kind::kNumber)) return Figure{.value = value.number};
  if (!value.is(JsonValue::Kind::kObject)) return std::nullopt;
  return Figure{number(value, "value"), true, number(value, "low"), number(value, "high")};
}

// An answer and what is looked up in it for its routes.
class Answer {
 public:
  explicit Answer(const JsonValue& document) : document_(document), routes_(routes_of(document)) {}

  const JsonValue& document() const { return document_; }
  const std::vector<AnsweredRoute>& routes() const { return routes_; }

  std::optional<Figure> figure(const AnsweredRoute& route, std::string_view key) const {
    // The interval of the stops is not in the summary.
    if (key == "expected_stops") return figure_of(at(at(judged(route), "outcomes"), key));
    return figure_of(at(*route.figures, key));
  }

  // "go", "no_go" or "unknown".
  const std::string& verdict(const AnsweredRoute& route) const {
    for (const JsonValue* const at_place : {route.figures, &document_, &at(document_, "decision")})
      if (has(*at_place, "verdict")) return text(*at_place, "verdict");
    return text(document_, "verdict");
  }

 private:
  // What has the outcomes of a route.
  const JsonValue& judged(const AnsweredRoute& route) const {
    return has(document_, "outcomes") || route.properties == nullptr ? document_ : *route.properties;
  }

  const JsonValue& document_;
  std::vector<AnsweredRoute> routes_;
};

void write_figure(Writer& w, std::string_view key, const std::optional<Figure>& figure) {
  w.key(key);
  if (!figure) {
    w.null();
  } else if (figure->has_interval) {
    w.begin_object().significant("value", figure->value).significant("low", figure->low);
    w.significant("high", figure->high).end_object();
  } else {
    w.significant(figure->value);
  }
}

void write_side(Writer& w, std::string_view side, const Answer& answer, const AnsweredRoute* route) {
  w.key(side);
  if (route == nullptr) {
    w.null();
    return;
  }
  w.begin_object();
  if (has(*route->figures, "rank")) w.whole("rank", std::lround(number(*route->figures, "rank")));
  w.text("verdict", answer.verdict(*route));
  for (const std::string_view key : kFigures)
    if (key != "cost" || has(*route->figures, key)) write_figure(w, key, answer.figure(*route, key));
  w.end_object();
}

void write_differences(Writer& w, const Answer& a, const Answer& b, const RoutePair& pair) {
  w.key("differences").begin_array();
  for (const std::string_view key : kFigures) {
    if (pair.a == nullptr || pair.b == nullptr) break;
    const std::optional<Figure> old = a.figure(*pair.a, key), now = b.figure(*pair.b, key);
    if (!old || !now) continue;
    w.begin_object().text("figure", key).significant("b_less_a", now->value - old->value);
    if (old->has_interval && now->has_interval)
      w.boolean("intervals_apart", old->low > now->high || now->low > old->high);
    w.end_object();
  }
  w.end_array();
}

bool same(const JsonValue& a, const JsonValue& b) {
  return a.kind == b.kind && a.boolean == b.boolean && a.number == b.number && a.text == b.text &&
         a.keys == b.keys &&
         std::equal(a.elements.begin(), a.elements.end(), b.elements.begin(), b.elements.end(), same);
}

// The members that differ, each at the deepest object that both requests have.
void write_changes(Writer& w, const std::string& pointer, const JsonValue& a, const JsonValue& b) {
  if (same(a, b)) return;
  if (!a.is(JsonValue::Kind::kObject) || !b.is(JsonValue::Kind::kObject)) {
    w.begin_object().text("key", pointer);
    write_value(w.key("a"), a);
    write_value(w.key("b"), b);
    w.end_object();
    return;
  }
  for (const std::string& key : a.keys) write_changes(w, child_pointer(pointer, key), at(a, key), at(b, key));
  for (const std::string& key : b.keys)
    if (a.find(key) == nullptr) write_changes(w, child_pointer(pointer, key), at(a, key), at(b, key));
}

Result<JsonValue> read(std::string_view side, std::string_view bytes) {
  const std::string pointer = fmt::format("/{}", side);
  auto document = parse(bytes, {.bytes = bytes.size(), .values = bytes.size()});
  if (!document)
    return fail(ErrorCode::kInvalidRequest, "an answer cannot be read", {{pointer, document.error().detail}});
  const std::string& format = text(*document, "format");
  if (std::find(kFormats.begin(), kFormats.end(), format) == kFormats.end())
    return fail(
        ErrorCode::kInvalidRequest, "no such answer can be compared",
        {{pointer, fmt::format("its format is \"{}\", must be plan/1, check/1 or prediction/1", format)}});
  return document;
}

Result<std::vector<RoutePair>> chosen_pairs(const Answer& a, const Answer& b,
                                            const std::optional<ComparedRoutes>& routes) {
  if (!routes) return pairs_of(a.routes(), b.routes());
  std::vector<Fault> faults;
  const auto choose = [&](const Answer& of, int rank, std::string_view side) -> const AnsweredRoute* {
    if (rank >= 1 && static_cast<std::size_t>(rank) <= of.routes().size())
      return &of.routes()[static_cast<std::size_t>(rank) - 1];
    faults.push_back({fmt::format("/{}", side),
                      fmt::format("has {} routes, and none of rank {}", of.routes().size(), rank)});
    return nullptr;
  };
  const AnsweredRoute* const one = choose(a, routes->a, "a");
  const AnsweredRoute* const other = choose(b, routes->b, "b");
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, "there is no such route", std::move(faults));
  return std::vector<RoutePair>{{one, other, apart_m(*one, *other)}};
}

}  // namespace

Result<std::string> compare_answers(std::string_view a, std::string_view b,
                                    const std::optional<ComparedRoutes>& routes) {
  const auto first = read("a", a);
  if (!first) return fail(first.error());
  const auto second = read("b", b);
  if (!second) return fail(second.error());
  const std::string& format = text(*first, "format");
  if (format != text(*second, "format"))
    return fail(ErrorCode::kInvalidRequest, "the answers are of different kinds",
                {{"/b", fmt::format("is a {}, must be a {} as the first", text(*second, "format"), format)}});
  const Answer before(*first), after(*second);
  const auto pairs = chosen_pairs(before, after, routes);
  if (!pairs) return fail(pairs.error());
  Writer w;
  w.begin_object().text("format", "answer-comparison/1").text("of", format);
  w.key("changed_in_request").begin_array();
  write_changes(w, "", at(*first, "request"), at(*second, "request"));
  w.end_array().key("routes").begin_array();
  for (const RoutePair& pair : *pairs) {
    w.begin_object();
    write_side(w, "a", before, pair.a);
    write_side(w, "b", after, pair.b);
    w.key("apart_m");
    const bool both_lines =
        pair.a != nullptr && pair.b != nullptr && !pair.a->line.empty() && !pair.b->line.empty();
    if (both_lines)
      w.metres(pair.apart_m);
    else
      w.null();
    write_differences(w, before, after, pair);
    w.end_object();
  }
  w.end_array().end_object();
  return w.take();
}

}  // namespace slipway::api::json
