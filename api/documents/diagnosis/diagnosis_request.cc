#include "api/documents/diagnosis/diagnosis_request.h"

#include "api/documents/model_object.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "core/largest_exact_whole.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::api::json {
namespace {

constexpr std::size_t kMaxWithheld = 100;

}  // namespace

void read_search_keys(ObjectReader& reader, std::vector<std::string>& without, std::uint64_t& seed) {
  reader.texts("without", kOptional, {0, kMaxWithheld}, {.most = 64, .is_name = true}, without);
  reader.whole("seed", kOptional, std::uint64_t{0}, kMaxExactWhole, seed);
  std::vector<std::string> known;
  for (const sim::Effect& effect : sim::effect_catalogue()) known.emplace_back(effect.name);
  for (std::size_t i = 0; i < without.size(); ++i)
    if (sim::find_effect(without[i]) == nullptr)
      reader.faults().push_back({child_pointer("/without", i), unknown_name("effect", without[i], known)});
}

Result<Reading<DiagnosisRequest>> read_diagnosis_request(std::string_view bytes) {
  const auto document = parse(bytes, {.bytes = RequestLimits::kBodyBytes});
  if (!document) return fail(document.error());
  Reading<DiagnosisRequest> reading;
  DiagnosisRequest& request = reading.request;
  ObjectReader reader(*document, "", reading.faults);
  if (!reader.is_object()) return reading;
  reader.text("campaign", kRequired, {.most = 64, .is_name = true}, request.campaign);
  reader.text("reference", kOptional, {.most = 64, .is_name = true}, request.reference);
  read_search_keys(reader, request.without, request.seed);
  reader.refuse_unknown();
  if (!request.reference.empty() && request.reference == request.campaign)
    reading.faults.push_back({"/reference", "must be other drives than those that are diagnosed"});
  return reading;
}

Result<Reading<ModelCheckRequest>> read_model_check_request(std::string_view bytes) {
  const auto document = parse(bytes, {.bytes = RequestLimits::kBodyBytes});
  if (!document) return fail(document.error());
  Reading<ModelCheckRequest> reading;
  ModelCheckRequest& request = reading.request;
  ObjectReader reader(*document, "", reading.faults);
  if (!reader.is_object()) return reading;
  reader.text("campaign", kRequired, {.most = 64, .is_name = true}, request.campaign);
  read_whole_model(reader, request.model);
  if (!request.model && !has_fault_under(reading.faults, "/model"))
    reading.faults.push_back({"/model", "is missing"});
  reader.whole("seed", kOptional, std::uint64_t{0}, kMaxExactWhole, request.seed);
  reader.refuse_unknown();
  return reading;
}

}  // namespace slipway::api::json
