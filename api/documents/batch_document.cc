#include "api/documents/batch_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "api/requests/plan_request.h"

namespace slipway::api::json {
namespace {

// Kinds whose requests stand alone and whose answers are documents.
const std::vector<std::string_view> kBatchKinds{"prediction", "check", "plan"};
constexpr double kMaxSeed = 4294967295.0;

struct Seeds {
  double first = 0.0;
  int count = 0;
};

std::optional<Seeds> read_seeds(ObjectReader& reader) {
  auto object = reader.object("seeds", kOptional);
  if (!object) return std::nullopt;
  Seeds seeds;
  object->whole("first", kRequired, 0.0, kMaxSeed - kMaxBatch, seeds.first);
  object->whole("count", kRequired, 1, kMaxBatch, seeds.count);
  object->refuse_unknown();
  return seeds;
}

std::string document_of(const JsonValue& request, const std::optional<double>& seed) {
  JsonValue asked = request;
  if (seed) {
    asked.keys.emplace_back("seed");
    JsonValue& value = asked.elements.emplace_back();
    value.kind = JsonValue::Kind::kNumber;
    value.number = *seed;
  }
  Writer w;
  write_value(w, asked);
  return w.take();
}

}  // namespace

Result<Reading<BatchRequest>> read_batch_request(std::string_view bytes) {
  const auto document = parse(bytes, {.bytes = RequestLimits::kBodyBytes});
  if (!document) return fail(document.error());
  Reading<BatchRequest> reading;
  BatchRequest& batch = reading.request;
  ObjectReader reader(*document, "", reading.faults);
  if (!reader.is_object()) return reading;
  std::size_t kind = 0;
  if (reader.choice("kind", kRequired, kBatchKinds, kind)) batch.kind = kBatchKinds[kind];
  const std::optional<Seeds> seeds = read_seeds(reader);
  const std::vector<Element> requests =
      reader.list("requests", kRequired, {.least = 1, .most = kMaxBatchRequests});
  for (const Element& element : requests) {
    if (!element.value->is(JsonValue::Kind::kObject))
      reading.faults.push_back({element.pointer, "must be a request, an object"});
    else if (seeds && element.value->find("seed") != nullptr)
      reading.faults.push_back({element.pointer + "/seed", "stands beside seeds, which set it"});
  }
  reader.refuse_unknown();
  const auto each = static_cast<std::size_t>(seeds ? std::max(seeds->count, 1) : 1);
  if (requests.size() * each > static_cast<std::size_t>(kMaxBatch))
    reader.fault("seeds", fmt::format("make {} requests of {}, must be at most {}", requests.size() * each,
                                      requests.size(), kMaxBatch));
  if (!reading.faults.empty()) return reading;
  batch.seeds = each;
  for (const Element& element : requests)
    for (std::size_t k = 0; k < each; ++k)
      batch.requests.push_back(document_of(
          *element.value, seeds ? std::optional(seeds->first + static_cast<double>(k)) : std::nullopt));
  return reading;
}

std::string write_batch_answer(const BatchAnswer& answer) {
  std::map<std::string, int> verdicts;
  for (const std::string& bytes : answer.documents) {
    const auto document = parse(bytes, {.bytes = bytes.size() + 1});
    const JsonValue* const verdict = document ? document->find("verdict") : nullptr;
    if (verdict != nullptr && verdict->is(JsonValue::Kind::kString)) ++verdicts[verdict->text];
  }
  Writer w;
  w.begin_object().text("format", "batch/1").text("kind", answer.kind);
  w.whole("answers", static_cast<std::int64_t>(answer.documents.size()));
  w.key("verdicts").begin_object();
  for (const auto& [verdict, count] : verdicts) w.whole(verdict, count);
  w.end_object().end_object();
  return w.take();
}

}  // namespace slipway::api::json
