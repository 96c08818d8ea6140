#include "api/files/model_folder.h"

#include <fmt/format.h>

#include <memory>
#include <system_error>
#include <utility>

#include "api/files/noise_scales.h"
#include "api/files/parameter_posterior.h"
#include "api/files/rover_file.h"
#include "api/files/soil_file.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "core/digest.h"

namespace slipway::api {
namespace {

constexpr std::string_view kFormat = "corrected-model/1";
constexpr std::size_t kMaxSoils = 1000;

struct Substitute {
  std::string nominal, corrected;
  std::string digest;  // of the nominal one
};

struct Description {
  std::string campaign;
  Substitute rover;
  std::vector<Substitute> soils;
  std::optional<gap::NoiseScales> noise;
  std::optional<gap::ParameterPosterior> left_open;
};

void write_substitute(json::Writer& w, const Substitute& substitute) {
  w.begin_object().text("nominal", substitute.nominal).text("corrected", substitute.corrected);
  w.text("nominal_digest", substitute.digest).end_object();
}

// The corrected name is that of a file.
Substitute read_substitute(json::ObjectReader reader) {
  Substitute substitute;
  reader.text("nominal", json::kRequired, {}, substitute.nominal);
  reader.text("corrected", json::kRequired, {.most = 100, .is_name = true}, substitute.corrected);
  reader.text("nominal_digest", json::kOptional, {}, substitute.digest);
  reader.refuse_unknown();
  return substitute;
}

Result<Description> read_description(std::string_view bytes) {
  const auto document = json::parse(bytes);
  if (!document) return fail(document.error());
  Description description;
  std::vector<Fault> faults;
  json::ObjectReader reader(*document, "", faults);
  std::size_t format = 0;
  reader.choice("format", json::kRequired, {kFormat}, format);
  reader.text("campaign", json::kRequired, {}, description.campaign);
  if (auto rover = reader.object("rover", json::kRequired)) description.rover = read_substitute(*rover);
  for (const json::Element& element : reader.list("soils", json::kRequired, {1, kMaxSoils}))
    description.soils.push_back(read_substitute(reader.object(element)));
  if (auto noise = reader.object("noise", json::kOptional))
    description.noise = json::read_noise_scales(*std::move(noise));
  description.left_open = json::read_parameter_posterior(reader);
  reader.refuse_unknown();
  if (!faults.empty()) return fail(ErrorCode::kUnreadableData, summary_of(faults), faults);
  return description;
}

// What a file of the folder holds; its faults with the file's name.
template <class Read>
auto read_file(const std::filesystem::path& folder, const std::string& file, const Read& read)
    -> decltype(read(std::string_view())) {
  const auto bytes = read_data_file(folder / file);
  if (!bytes)
    return fail(ErrorCode::kUnreadableData, bytes.error().detail, {{file + "#", bytes.error().detail}});
  auto value = read(*bytes);
  if (value) return value;
  const std::vector<Fault>& faults = value.error().faults;
  return fail(ErrorCode::kUnreadableData, fmt::format("{}: {}", file, value.error().detail),
              faults.empty() ? std::vector<Fault>{{file + "#", value.error().detail}}
                             : moved_under(file + "#", faults));
}

}  // namespace

Result<std::optional<std::string>> remove_model(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path described = folder / "model.json";
  if (!fs::exists(fs::symlink_status(described, error))) return std::nullopt;
  const auto description = read_file(folder, "model.json", read_description);
  if (!description) return fail(description.error());
  // The description first: without it the folder holds no model, even where the rest can't be removed.
  for (const fs::path& path : {described, folder / "rovers" / (description->rover.corrected + ".json"),
                               folder / "soils" / (description->soils.front().corrected + ".json")})
    if (fs::remove(path, error); error)
      return fail(ErrorCode::kUnwritableFile,
                  fmt::format("cannot remove {}: {}", path.string(), error.message()));
  return description->campaign;
}

std::string digest_of(const sim::RoverModel& rover) {
  sim::RoverModel same = rover;
  same.summary.clear();
  same.sources.clear();
  same.drive.max_wheel_rate_rad_s = 0.0;
  json::Writer w;
  json::write_rover(w, same);
  return fmt::format("{:016x}", fnv1a(w.take()));
}

std::string digest_of(const gap::NominalSoil& soil) {
  sim::SoilDistribution same;
  same.mean = soil.soil;
  json::Writer w;
  json::write_soil(w, same);
  return fmt::format("{:016x}", fnv1a(w.take()));
}

std::string model_document(const gap::DriveCampaign& campaign, const CorrectedModel& model) {
  json::Writer w;
  w.begin_object().text("format", kFormat).text("campaign", campaign.name).key("rover");
  write_substitute(w, {campaign.rover->name, model.rover.name, digest_of(*campaign.rover)});
  w.key("soils").begin_array();
  for (std::size_t i = 0; i < model.soils.size(); ++i)
    write_substitute(w, {campaign.soils[i].name, model.soils[i].name, digest_of(campaign.soils[i])});
  w.end_array();
  if (model.noise) json::write_noise_scales(w.key("noise"), *model.noise);
  if (model.left_open) json::write_parameter_posterior(w, *model.left_open);
  w.end_object();
  return w.take();
}

Result<ModelFolder> load_model_folder(const std::filesystem::path& folder) {
  const auto description = read_file(folder, "model.json", read_description);
  if (!description) return fail(description.error());
  ModelFolder loaded{description->campaign, description->rover.nominal, {}, {}};
  loaded.rover_digest = description->rover.digest;
  loaded.model.noise = description->noise;
  loaded.model.left_open = description->left_open;
  std::vector<Fault> faults;
  auto rover =
      read_file(folder, fmt::format("rovers/{}.json", description->rover.corrected), json::read_rover_file);
  if (rover && rover->name != description->rover.corrected)
    faults.push_back({"model.json#/rover/corrected",
                      fmt::format("the rover of that file is called {}", in_quotes(rover->name))});
  if (!rover) faults = rover.error().faults;
  // A soils' file is called as its first soil.
  const auto soils = read_file(folder, fmt::format("soils/{}.json", description->soils.front().corrected),
                               [](std::string_view bytes) { return json::read_soil_file(bytes); });
  if (!soils) faults.insert(faults.end(), soils.error().faults.begin(), soils.error().faults.end());
  for (std::size_t i = 0; soils && i < description->soils.size(); ++i) {
    const Substitute& substitute = description->soils[i];
    std::vector<std::string> names;
    for (const sim::SoilDistribution& soil : *soils) {
      names.push_back(soil.name);
      if (soil.name == substitute.corrected) loaded.model.soils.push_back(soil);
    }
    loaded.nominal_soils.push_back(substitute.nominal);
    loaded.soil_digests.push_back(substitute.digest);
    if (loaded.model.soils.size() != i + 1 && faults.empty())
      faults.push_back({fmt::format("model.json#/soils/{}/corrected", i),
                        unknown_name("soil", substitute.corrected, names)});
  }
  if (!faults.empty())
    return fail(ErrorCode::kUnreadableData, fmt::format("the model has {}", summary_of(faults)), faults);
  loaded.model.rover = *std::move(rover);
  return loaded;
}

Error not_of_this_rover(const ModelFolder& folder, const std::string& rover) {
  const std::string message = fmt::format("the model was made of {}: it says nothing of {}",
                                          in_quotes(folder.nominal_rover), in_quotes(rover));
  return {ErrorCode::kInvalidRequest, message, {{"/rover", message}}};
}

Result<Catalogue> with_model(Catalogue catalogue, const ModelFolder& folder,
                             const std::vector<std::string>& ground) {
  const CorrectedModel& model = folder.model;
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < ground.size(); ++i) {
    const std::string pointer = fmt::format("/ground/{}", i);
    if (!catalogue.soils.contains(ground[i]))
      faults.push_back({pointer, unknown_soil(catalogue, ground[i])});
    else if (model.soils.size() > 1)
      faults.push_back({pointer, fmt::format("the model has {} soils: which of them {} is can't be told",
                                             model.soils.size(), in_quotes(ground[i]))});
    else
      catalogue.soils[ground[i]] = model.soils.front();
  }
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  for (std::size_t i = 0; i < model.soils.size(); ++i) {
    if (const auto nominal = catalogue.soils.find(folder.nominal_soils[i]); nominal != catalogue.soils.end())
      nominal->second = model.soils[i];
    catalogue.soils[model.soils[i].name] = model.soils[i];
  }
  catalogue.rovers[model.rover.name] = std::make_shared<const sim::RoverModel>(model.rover);
  return catalogue;
}

}  // namespace slipway::api
