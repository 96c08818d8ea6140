#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "api/files/catalogue.h"
#include "api/files/corrected_model.h"
#include "core/result.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::api {

// A corrected model as `slipway diagnose --model` writes it, and what it stands in for: rovers/*.json and
// soils/*.json as a data folder has them, and model.json.
struct ModelFolder {
  std::string campaign;
  std::string nominal_rover;
  std::vector<std::string> nominal_soils;  // in the order of model.soils
  CorrectedModel model;
  // Of the values that the nominal rover and soils had, see digest_of; empty where it is not known.
  std::string rover_digest = {};
  std::vector<std::string> soil_digests = {};
};

// Another one for other values of the rover (its greatest wheel rate apart, which drives raise) or of the
// soil, whatever they are called.
std::string digest_of(const sim::RoverModel& rover);
std::string digest_of(const gap::NominalSoil& soil);

// model.json ("corrected-model/1"): what each of its names stands in for.
std::string model_document(const gap::DriveCampaign& campaign, const CorrectedModel& model);

// The faults of all its files are reported together, as those of a data folder.
Result<ModelFolder> load_model_folder(const std::filesystem::path& folder);

// Takes the model out of a folder: model.json and the files of rover and soils that it names; other files
// stay. The name of the campaign that it was made of; nothing where the folder holds no model. Errors:
// unreadable_data where model.json is none of ours; unwritable_file.
Result<std::optional<std::string>> remove_model(const std::filesystem::path& folder);

// That a rover is neither the one that the model was made of nor the corrected one: invalid_request at
// /rover.
Error not_of_this_rover(const ModelFolder& folder, const std::string& rover);

// The catalogue with the model's rover and soils in it, by their names. Ground that is one of the nominal
// soils by name, or one of `ground`, is the corrected one. Errors: invalid_request at /ground for a soil that
// the catalogue does not have, and where the model has several soils, which one it is would be a guess.
Result<Catalogue> with_model(Catalogue catalogue, const ModelFolder& folder,
                             const std::vector<std::string>& ground);

}  // namespace slipway::api
