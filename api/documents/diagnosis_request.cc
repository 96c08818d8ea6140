#include "api/documents/diagnosis_request.h"

#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::api::json {
namespace {

constexpr std::uint64_t kMaxExactWhole = 9'007'199'254'740'991;  // 2^53 - 1
constexpr std::size_t kMaxWithheld = 100;

}  // namespace

Result<Reading<DiagnosisRequest>> read_diagnosis_request(std::string_view bytes) {
  const auto document = parse(bytes, {.bytes = RequestLimits::kBodyBytes});
  if (!document) return fail(document.error());
  Reading<DiagnosisRequest> reading;
  DiagnosisRequest& request = reading.request;
  ObjectReader reader(*document, "", reading.faults);
  if (!reader.is_object()) return reading;
  reader.text("campaign", kRequired, {.most = 64, .is_name = true}, request.campaign);
  reader.text("reference", kOptional, {.most = 64, .is_name = true}, request.reference);
  reader.texts("without", kOptional, {0, kMaxWithheld}, {.most = 64, .is_name = true}, request.without);
  reader.whole("seed", kOptional, std::uint64_t{0}, kMaxExactWhole, request.seed);
  reader.refuse_unknown();
  if (!request.reference.empty() && request.reference == request.campaign)
    reading.faults.push_back({"/reference", "must be other drives than those that are diagnosed"});
  std::vector<std::string> known;
  for (const sim::Effect& effect : sim::effect_catalogue()) known.emplace_back(effect.name);
  for (std::size_t i = 0; i < request.without.size(); ++i)
    if (sim::find_effect(request.without[i]) == nullptr)
      reading.faults.push_back(
          {child_pointer("/without", i), unknown_name("effect", request.without[i], known)});
  return reading;
}

}  // namespace slipway::api::json
