#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/drive_campaign.h"
#include "gap/diagnosis/model/noise_model.h"
#include "gap/diagnosis/search/parameter_posterior.h"
#include "sim/rover/rover_model.h"
#include "sim/soil/soil.h"

namespace slipway::gap {

// How a corrected model tells the drives of a campaign that it was not made of, beside the campaign's own
// nominal one.

// What is believed before the drives are looked at.
struct CorrectedBelief {
  std::shared_ptr<const sim::RoverModel> rover;  // with the effects found
  std::vector<sim::SoilDistribution> soils;      // as DriveCampaign::soils
  std::vector<std::string> called;               // what each soil was called in the campaign diagnosed
  NoiseScales scatter;                           // of drives, as it was there
  ParameterPosterior left_open;                  // by those drives; its soils as they were called
};

// One observation, in its channel's unit.
struct PredictedValue {
  Channel channel = Channel::kSlip;
  std::size_t group = 0;      // its drive's; repeats share theirs
  double gradient_rad = 0.0;  // along the travel, positive uphill
  double measured = 0.0, nominal = 0.0, corrected = 0.0;
  double deviation = 0.0;  // of the corrected prediction
};

enum class SlopeClass { kAll, kUp, kLevel, kDown };
inline constexpr std::array kSlopeClasses{SlopeClass::kAll, SlopeClass::kUp, SlopeClass::kLevel,
                                          SlopeClass::kDown};
constexpr double kLevelWithin_deg = 8.0;
std::string_view name_of(SlopeClass slope);  // "all", "up", "level", "down"

// An error of both models, and how far down the correction brings it. down is negative where it got worse;
// its 90 % interval is bootstrapped over drives, and none is given for fewer than kMinDrives.
struct ErrorChange {
  double nominal = 0.0, corrected = 0.0, down_percent = 0.0;
  std::optional<Interval> down_interval;
};
constexpr std::size_t kMinDrives = 5;

struct ChannelCheck {
  Channel channel = Channel::kSlip;
  SlopeClass slope = SlopeClass::kAll;
  std::size_t values = 0, drives = 0;       // observations; drives that are no repeats
  ErrorChange rms, median;                  // of predicted less measured; median of its magnitude
  double within_50 = 0.0, within_90 = 0.0;  // shares of the values in the corrected prediction's intervals
};

struct ModelCheckOptions {
  WindowOptions windows;
  PreparationOptions preparation;
  DiscrepancyOptions discrepancy;  // of the levers, by which the map's detail acts
  std::size_t threads = 0;
  std::uint64_t seed = 1;
  int resamples = 1000;
};

// Each channel that has values, by slope class where it has some.
std::vector<ChannelCheck> score_predicted(std::span<const PredictedValue> predicted,
                                          const ModelCheckOptions& options);

struct ModelCheck {
  std::vector<ChannelCheck> channels;
  std::size_t drives = 0, windows = 0, values = 0;
  std::size_t unanswered_nominal = 0, unanswered_corrected = 0;  // values one of the models has no number for
};

// Errors: cancelled.
Result<ModelCheck> check_model(const DriveCampaign& campaign, const CorrectedBelief& belief,
                               const ModelCheckOptions& options, Progress& progress);

}  // namespace slipway::gap
