#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "api/files/catalogue.h"
#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/drive_soil_estimation.h"
#include "gap/diagnosis/model/drive_campaign.h"
#include "gap/estimate/soil_estimation.h"
#include "sim/single_wheel/wheel_sweep.h"

namespace slipway::api {

// The wheel of tests that do not describe their own: a rover's, or one given by its numbers.
struct TestedWheel {
  std::string rover;  // without a rover there is no motor
  std::string wheel;  // of the rover; its first where it is empty
  std::optional<double> radius_m, width_m;
  std::optional<sim::Grousers> grousers;
  std::optional<double> motor_temp_c;
};

// A wheel that tests name, and what it has that differs from the others'; radius, width and grousers alone.
struct NamedWheel {
  std::string name;
  TestedWheel wheel;
};
// A soil that tests name, and the soil of the catalogue that its search starts from.
struct TestedSoil {
  std::string name, soil;
};

// POST /v1/soil-estimates asks which soil these tests, or these drives, show.
struct SoilEstimateRequest {
  std::string soil = "unknown_ground";  // the start of the search and the mean of the priors
  std::vector<TestedSoil> soils;        // of those that start elsewhere
  TestedWheel wheel;
  std::vector<NamedWheel> wheels;
  // What is at work and what stands at another value: a name, and with "@LABEL" of one wheel or soil of the
  // tests alone. Names of `set` are gap::free_parameter's. A parameter that is set and free starts there.
  std::vector<sim::EffectSetting> effects;
  std::vector<sim::SweepSetting> set;
  double gravity_m_s2 = 3.71;  // where the wheels were tested; only effects use it
  double speed_m_s = 0.04;     // of the rim; used by the motor and the effect rate_shear
  gap::SoilData data;    // tests; wheel tests have only loads, motions and readings, and there are no rigs
  std::string campaign;  // of drives; there are no tests then
  gap::SoilEstimationOptions options;  // of tests
  std::vector<bool> looked_at;         // channels of drives; empty: all
};

// Switches off all channels but these, which have gap::SoilChannel's names for tests and gap::Channel's for
// drives. Returns a fault for each unknown name, at "/channels/0".
std::vector<Fault> choose_channels(const std::vector<std::string>& names, SoilEstimateRequest& request);

// The request with every name and default filled in, and the estimates: one of tests, one a soil of drives.
struct SoilEstimateAnswer {
  SoilEstimateRequest request;
  std::string nominal;  // name of the soil, or of the campaign
  std::vector<gap::SoilEstimate> estimates;
  std::vector<gap::DriveChannelResidual> drive_channels;
  std::size_t windows = 0;  // of drives
};

// Errors: invalid_request with the faults of names and numbers; those of gap::estimate_soil.
Result<SoilEstimateAnswer> estimate_soil(const Catalogue& catalogue, const SoilEstimateRequest& request,
                                         Progress& progress);
// The same from the drives of a campaign that has been read.
Result<SoilEstimateAnswer> estimate_soil(const gap::DriveCampaign& campaign,
                                         const SoilEstimateRequest& request, std::size_t threads,
                                         Progress& progress);

// The faults of names and geometry, without estimating: "/soil", "/rover", "/wheel", "/radius_m".
std::vector<Fault> faults_of(const Catalogue& catalogue, const SoilEstimateRequest& request);

}  // namespace slipway::api
