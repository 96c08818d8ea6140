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

// Which drives are made after the first ones: of the pool, those that come nearest to proposals of the last
// diagnosis, each proposal in turn as well as the pool can serve it (where there is none, any), or any.
enum class AcquisitionPolicy { kDesigned, kRandom };

struct AcquisitionOptions {
  std::size_t first = 4;     // drives to begin with
  std::size_t most = 24;     // drives in all
  std::uint64_t seed = 1;    // of what is drawn
  std::uint64_t repeat = 0;  // of the same policy: other draws
};

// How many drives each step has: 2 more at a time, from 12 on 4 more.
std::vector<std::size_t> acquisition_sizes(const AcquisitionOptions& options, std::size_t pool);

// The drives that tell least, nearest to level, straight, at cruise speed and 20 degC.
std::vector<std::size_t> first_drives(const DriveCampaign& campaign, std::size_t count);

// Indices of drives that are added to those `made`. Deterministic.
std::vector<std::size_t> designed_drives(const DriveCampaign& campaign, std::span<const std::size_t> made,
                                         std::span<const NextDrive> proposed, std::size_t count,
                                         const AcquisitionOptions& options);
std::vector<std::size_t> random_drives(const DriveCampaign& campaign, std::span<const std::size_t> made,
                                       std::size_t count, const AcquisitionOptions& options);

// Diagnoses some of the drives.
using DrivesDiagnosis = std::function<Result<Diagnosis>(const DriveCampaign&)>;
// What somebody who knows the answer says of a diagnosis. A policy never hears it: it is written down, and a
// run ends early once two steps in a row are right.
using DrivesJudge = std::function<bool(const Diagnosis&)>;

struct AcquisitionStep {
  std::size_t drives = 0;
  bool right = false;
};

// Adds drives step by step and diagnoses what is there. `first` is the diagnosis of the first drives, which
// all runs have in common. Errors: those of the diagnosis.
Result<std::vector<AcquisitionStep>> acquire_drives(const DriveCampaign& campaign, const Diagnosis& first,
                                                    AcquisitionPolicy policy,
                                                    const AcquisitionOptions& options,
                                                    const DrivesDiagnosis& diagnosis,
                                                    const DrivesJudge& judge);

}  // namespace slipway::gap
