#pragma once

#include <optional>
#include <vector>

#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/drive_campaign.h"
#include "gap/diagnosis/model/noise_model.h"
#include "sim/rover/effect_setting.h"
#include "sim/rover/rover_model.h"
#include "sim/soil/soil.h"

namespace slipway::api {

// What a diagnosis offers to plan with: the nominal rover (Diagnosis::nominal_rover) with re-tuned motors,
// which carries the effects that were found, and the re-tuned nominal soils with what is believed of them
// now. Names end in the campaign's and a version that is another for other numbers: "mer-class-p05-3f9a2c".
struct CorrectedModel {
  sim::RoverModel rover;
  std::vector<sim::SoilDistribution> soils;  // in the campaign's order
  std::vector<sim::EffectSetting> effects;   // all that are at work; places on a map are in no rover's file
  std::optional<gap::NoiseScales> noise;     // what the campaign's drives scatter by, where it is known
  std::optional<gap::ParameterPosterior> left_open;  // what they leave open, where it is known
};

// Nothing where the diagnosis offers none.
std::optional<CorrectedModel> corrected_model(const gap::DriveCampaign& campaign,
                                              const gap::Diagnosis& diagnosis);

}  // namespace slipway::api
