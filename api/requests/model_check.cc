#include "api/requests/model_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "api/json/faults.h"

namespace slipway::api {
namespace {

std::vector<std::string> notes_of(const gap::DriveCampaign& campaign, const ModelFolder& model,
                                  const gap::ModelCheck& check) {
  std::vector<std::string> notes{
      "Intervals of the corrected prediction account for the uncertainty that the diagnosis left in soils, "
      "closures, motors and effects, for the scatter of drives and windows as it was in its campaign, and "
      "for "
      "these drives' sensors; they do not account for errors of the laws."};
  if (!model.model.left_open)
    notes.emplace_back(
        "The model does not state the uncertainty that its drives left (model.json has no \"left_open\"): "
        "the "
        "intervals account for scatter and sensors alone.");
  if (!model.model.noise)
    notes.emplace_back(
        "The model does not state the scatter of its drives (model.json has no \"noise\"): the usual scatter "
        "is "
        "assumed.");
  const auto other_values = [&](std::string_view what, const std::string& name) {
    notes.push_back(
        fmt::format("The {} {} has other nominal values here than in the campaign from which the model was "
                    "made: the corrected predictions use the model's.",
                    what, in_quotes(name)));
  };
  if (!model.rover_digest.empty() && model.rover_digest != digest_of(*campaign.rover))
    other_values("rover", campaign.rover->name);
  for (const gap::NominalSoil& soil : campaign.soils)
    for (std::size_t s = 0; s < model.soil_digests.size(); ++s)
      if (soil.name == model.nominal_soils[s] && !model.soil_digests[s].empty() &&
          model.soil_digests[s] != digest_of(soil))
        other_values("soil", soil.name);
  if (model.campaign == campaign.name)
    notes.push_back(
        fmt::format("The model was corrected with a campaign that is called {} too: if these are the drives "
                    "to which it was "
                    "fitted, the figures do not apply to future drives.",
                    in_quotes(campaign.name)));
  if (check.unanswered_nominal + check.unanswered_corrected > 0)
    notes.push_back(fmt::format(
        "Left out: values for which a model says that the rover would not move ({} by the nominal, {} by the "
        "corrected one).",
        check.unanswered_nominal, check.unanswered_corrected));
  if (std::any_of(check.channels.begin(), check.channels.end(),
                  [](const gap::ChannelCheck& c) { return c.drives < gap::kMinDrives; }))
    notes.push_back(fmt::format("Channels with fewer than {} drives, repeats counted once, have no interval.",
                                gap::kMinDrives));
  return notes;
}

}  // namespace

Result<gap::CorrectedBelief> belief_of(const gap::DriveCampaign& campaign, const ModelFolder& model,
                                       const std::vector<std::string>& ground) {
  std::vector<Fault> faults;
  if (campaign.rover->name != model.nominal_rover)
    faults.push_back(
        {"/rover/name", fmt::format("the campaign's rover is {}, the model's was {}",
                                    in_quotes(campaign.rover->name), in_quotes(model.nominal_rover))});
  else if (campaign.rover->wheels.size() != model.model.rover.wheels.size())
    faults.push_back(
        {"/rover/wheels", fmt::format("are {}, the model's rover has {}", campaign.rover->wheels.size(),
                                      model.model.rover.wheels.size())});
  Catalogue nominal;
  for (const gap::NominalSoil& soil : campaign.soils) nominal.soils[soil.name].name = soil.name;
  const auto corrected = with_model(std::move(nominal), model, ground);
  if (!corrected)
    faults.insert(faults.end(), corrected.error().faults.begin(), corrected.error().faults.end());
  gap::CorrectedBelief belief;
  belief.rover = std::make_shared<const sim::RoverModel>(model.model.rover);
  belief.scatter = model.model.noise.value_or(gap::NoiseScales{});
  belief.left_open = model.model.left_open.value_or(gap::ParameterPosterior{});
  for (const gap::NominalSoil& soil : campaign.soils) {
    if (!corrected) break;
    belief.soils.push_back(corrected->soils.at(soil.name));
    for (std::size_t s = 0; s < model.model.soils.size(); ++s)
      if (model.model.soils[s].name == belief.soils.back().name)
        belief.called.push_back(model.nominal_soils[s]);
    if (belief.soils.back().name == soil.name)
      faults.push_back({"/soils/" + soil.name,
                        fmt::format("{} is none of the soils that the model corrects: {}; where it is one of "
                                    "them under another name, name it as ground",
                                    in_quotes(soil.name), fmt::join(model.nominal_soils, ", "))});
  }
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  return belief;
}

Result<ModelCheckAnswer> check_model(const gap::DriveCampaign& campaign, const ModelFolder& model,
                                     const std::vector<std::string>& ground,
                                     const gap::ModelCheckOptions& options, Progress& progress) {
  const auto belief = belief_of(campaign, model, ground);
  if (!belief) return fail(belief.error());
  auto check = gap::check_model(campaign, *belief, options, progress);
  if (!check) return fail(check.error());
  ModelCheckAnswer answer{campaign.name,
                          campaign.fingerprint,
                          model.campaign,
                          model.model.rover.name,
                          {},
                          options.seed,
                          *std::move(check),
                          {}};
  for (const sim::SoilDistribution& soil : belief->soils) answer.soils.push_back(soil.name);
  answer.notes = notes_of(campaign, model, answer.check);
  return answer;
}

}  // namespace slipway::api
