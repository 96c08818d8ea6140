#include "api/documents/model_object.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "api/files/model_folder.h"
#include "api/files/rover_file.h"
#include "api/files/soil_file.h"
#include "api/json/faults.h"
#include "api/json/parse.h"

namespace slipway::api::json {
namespace {

constexpr std::string_view kPointer = "/model";
constexpr CountRule kGround{0, 20}, kSoils{1, 1000};
constexpr TextRule kName{.most = 100};

void read_reference(ObjectReader& reader, RequestedModel& model) {
  reader.text("diagnosis", kRequired, {.most = 64, .is_name = true}, model.diagnosis);
  reader.texts("ground", kOptional, kGround, kName, model.ground);
}

// A member that is a document by itself; its faults with their places in the request.
template <class Read>
auto read_document(ObjectReader& reader, std::string_view key, const Read& read)
    -> decltype(read(std::string_view())) {
  const JsonValue* const value = reader.member(key, kRequired);
  if (value == nullptr) return fail(ErrorCode::kInvalidRequest, "is missing");
  Writer w;
  write_value(w, *value);
  auto document = read(w.take());
  if (document) return document;
  const std::vector<Fault>& faults = document.error().faults;
  const std::string pointer = child_pointer(reader.pointer(), key);
  std::vector<Fault> here = moved_under(pointer, faults);
  if (here.empty()) here.push_back({pointer, document.error().detail});
  reader.faults().insert(reader.faults().end(), here.begin(), here.end());
  return document;
}

}  // namespace

std::optional<RequestedModel> read_model_reference(const JsonValue& value, std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  RequestedModel model;
  ObjectReader reader(value, std::string(kPointer), faults);
  if (!reader.is_object()) return std::nullopt;
  read_reference(reader, model);
  reader.refuse_unknown();
  if (faults.size() != before) return std::nullopt;
  return model;
}

void write_model_reference(Writer& w, const RequestedModel& model) {
  w.begin_object().text("diagnosis", model.diagnosis).texts("ground", model.ground).end_object();
}

Result<std::string> whole_model(const RequestedModel& reference, std::string_view diagnosis_document) {
  const auto document =
      parse(diagnosis_document, {.bytes = diagnosis_document.size(), .values = diagnosis_document.size()});
  if (!document) return fail(ErrorCode::kInternal, "a diagnosis that was kept can't be read");
  const JsonValue* diagnosis = &*document;
  if (const JsonValue* const format = document->find("format");
      format != nullptr && format->text == "watch/1") {
    diagnosis = document->find("diagnosis");
    if (diagnosis == nullptr)
      return fail(ErrorCode::kInvalidRequest, "the watch made no diagnosis, so that it offers no model");
  }
  const JsonValue* const offered = diagnosis->find("model");
  if (offered == nullptr) {
    const JsonValue* const verdict = diagnosis->find("verdict");
    return fail(ErrorCode::kInvalidRequest, fmt::format("the diagnosis offers no model: its verdict is {}",
                                                        verdict == nullptr ? "not given" : verdict->text));
  }
  Writer w;
  w.begin_object().text("diagnosis", reference.diagnosis).texts("ground", reference.ground);
  for (const std::string_view key : {"campaign", "nominal", "rover", "soils"}) {
    const JsonValue* const value = offered->find(key);
    if (value == nullptr)
      return fail(ErrorCode::kInvalidRequest,
                  fmt::format("the diagnosis was made by an earlier version: its model has no {}; ask for it "
                              "again",
                              in_quotes(key)));
    write_value(w.key(key), *value);
  }
  w.end_object();
  return w.take();
}

void read_whole_model(ObjectReader& reader, std::optional<RequestedModel>& model) {
  auto object = reader.object("model", kOptional);
  if (!object) return;
  RequestedModel requested;
  read_reference(*object, requested);
  if (object->member("rover", kOptional) == nullptr) {
    object->fault("diagnosis", "names a job, which only a service that runs knows");
    return;
  }
  const std::size_t before = reader.faults().size();
  auto folder = std::make_shared<ModelFolder>();
  object->text("campaign", kRequired, {}, folder->campaign);
  if (auto nominal = object->object("nominal", kRequired)) {
    nominal->text("rover", kRequired, {}, folder->nominal_rover);
    nominal->texts("soils", kRequired, kSoils, {}, folder->nominal_soils);
    nominal->refuse_unknown();
  }
  auto rover = read_document(*object, "rover", read_rover_file);
  auto soils = read_document(*object, "soils", [](std::string_view bytes) { return read_soil_file(bytes); });
  object->refuse_unknown();
  if (soils && soils->size() != folder->nominal_soils.size())
    object->fault("soils", fmt::format("are {}, must be as many as the nominal ones", soils->size()));
  if (!rover || !soils || reader.faults().size() != before) return;
  folder->model.rover = *std::move(rover);
  folder->model.soils = *std::move(soils);
  requested.corrected = std::move(folder);
  model = std::move(requested);
}

std::string with_member_model(const JsonValue& request, const std::optional<std::string>& model) {
  Writer w;
  w.begin_object();
  for (std::size_t i = 0; i < request.keys.size(); ++i) {
    const bool is_model = request.keys[i] == "model";
    if (is_model && !model) continue;
    w.key(request.keys[i]);
    if (is_model)
      w.raw(*model);
    else
      write_value(w, request.elements[i]);
  }
  w.end_object();
  return w.take();
}

}  // namespace slipway::api::json
