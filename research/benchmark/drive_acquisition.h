#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/result.h"
#include "gap/diagnosis/diagnosis.h"
#include "gap/diagnosis/model/drive_campaign.h"

namespace slipway::gap {

// How drives are chosen after the first ones. "Designed" takes from the pool the drives nearest to the
// proposals of the last diagnosis, for each proposal in turn (any drives where there is no proposal);
// "random" takes any.
enum class AcquisitionPolicy { kDesigned, kRandom };

struct AcquisitionOptions {
  std::size_t first = 4;     // drives to begin with
  std::size_t most = 24;     // drives in all
  std::uint64_t seed = 1;    // of the random draws
  std::uint64_t repeat = 0;  // number of the run; another run of the same policy has other draws
};

// The number of drives at each step: 2 more each time, and from 12 on 4 more.
std::vector<std::size_t> acquisition_sizes(const AcquisitionOptions& options, std::size_t pool);

// The drives with the least information: those nearest to level, straight, at cruise speed and 20 degC.
std::vector<std::size_t> first_drives(const DriveCampaign& campaign, std::size_t count);

// Indices of the drives that are added to those `made`. The same arguments give the same drives.
std::vector<std::size_t> designed_drives(const DriveCampaign& campaign, std::span<const std::size_t> made,
                                         std::span<const NextDrive> proposed, std::size_t count,
                                         const AcquisitionOptions& options);
std::vector<std::size_t> random_drives(const DriveCampaign& campaign, std::span<const std::size_t> made,
                                       std::size_t count, const AcquisitionOptions& options);

// Diagnoses some of the drives.
using DrivesDiagnosis = std::function<Result<Diagnosis>(const DriveCampaign&)>;
// Whether a diagnosis is right, by the key. It is recorded, and a run ends early once two steps in a row are
// right, but a policy does not use it.
using DrivesJudge = std::function<bool(const Diagnosis&)>;

struct AcquisitionStep {
  std::size_t drives = 0;
  bool right = false;
};

// Adds drives step by step and diagnoses the drives so far. `first` is the diagnosis of the first drives,
// which all runs have in common. Errors: those of the diagnosis.
Result<std::vector<AcquisitionStep>> acquire_drives(const DriveCampaign& campaign, const Diagnosis& first,
                                                    AcquisitionPolicy policy,
                                                    const AcquisitionOptions& options,
                                                    const DrivesDiagnosis& diagnosis,
                                                    const DrivesJudge& judge);

}  // namespace slipway::gap
