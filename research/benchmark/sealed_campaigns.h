#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/drive_csv.h"
#include "campaign/drive_table.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::campaign {

// A campaign to judge the diagnosis by: dynamic drives with something hidden, and what its operators know.
struct SealedCampaign {
  std::string name;     // "d01": says nothing of what is in it
  DriveTable driven;    // as it is: the soils' true means, true motors, effects at work
  DriveTable believed;  // as its operators know it: of the same drives
  // What is hidden. An effect with a region is a soil of the driven terrain, not an effect of the driven
  // table.
  std::vector<sim::EffectSetting> hidden;
  std::optional<sim::Disc> place;  // of an effect with a region
  double size = 1.0;               // of the hidden effects, in multiples of the usual one
  std::string soil;                // which one, for the key
  std::string nominal;             // how far what is believed is off: "true", "near", "usual", "far"
  std::string kind;                // "tilt", "rough"
  CsvOptions recorded;             // channels that are there
};

// "smoke": two small ones, for a test. "each": every effect that can be hidden once, three pairs and four
// controls, of which two have only parameters off; wheels and linkage weigh next to nothing, as in the
// quasi-static fidelity level. "each_heavy_wheels": the same with the weights that the dynamic level has.
std::span<const std::string_view> sealed_sets();

// The campaigns of a set, their order drawn. The same set and seed give the same campaigns, whatever the
// machine. The rover is what operators know. set must be one of sealed_sets().
std::vector<SealedCampaign> sealed_campaigns(std::string_view set, std::uint64_t seed,
                                             const std::shared_ptr<const sim::RoverModel>& rover);

}  // namespace slipway::campaign
