#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "api/catalogue.h"
#include "api/corrected_model.h"
#include "core/result.h"
#include "gap/drive_campaign.h"

namespace slipway::api {

// A corrected model as `slipway diagnose --model` writes it, and what it stands in for: rovers/*.json and
// soils/*.json as a data folder has them, and model.json.
struct ModelFolder {
  std::string campaign;
  std::string nominal_rover;
  std::vector<std::string> nominal_soils;  // in the order of model.soils
  CorrectedModel model;
};

// model.json ("corrected-model/1"): what each of its names stands in for.
std::string model_document(const gap::DriveCampaign& campaign, const CorrectedModel& model);

// The faults of all its files are reported together, as those of a data folder.
Result<ModelFolder> load_model_folder(const std::filesystem::path& folder);

// The catalogue with the model's rover and soils in it, by their names. Ground that is one of the nominal
// soils by name, or one of `ground`, is the corrected one. Errors: invalid_request at /ground for a soil that
// the catalogue does not have, and where the model has several soils, which one it is would be a guess.
Result<Catalogue> with_model(Catalogue catalogue, const ModelFolder& folder,
                             const std::vector<std::string>& ground);

}  // namespace slipway::api
