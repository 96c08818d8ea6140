#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/diagnosis/follow/change_detector.h"
#include "gap/diagnosis/model/drive_campaign.h"
#include "gap/diagnosis/search/diagnosis_options.h"

namespace slipway::gap {

struct WatchedDrive {
  std::string id;
  std::size_t windows = 0;      // of use: positions and attitudes on the terrain; a drive of 0 says nothing
  double log10_evidence = 0.0;  // up to this drive
  bool alarm = false;           // at this drive or before
};

// What could have changed, and its share of the evidence at the alarm (without one: at the last drive);
// shares add up to 1. "unknown": nothing of the library.
struct ChangeShare {
  std::string name;
  double share = 0.0;
};

// Of the evidence of a change, what the drives together have that are told as the range of its onset.
inline constexpr double kOnsetPart = 0.9;

// Drives in their order, each with the evidence so far that they no longer are what healthy ones taught: see
// change_detector.h. Which kinds of change there are, and in which directions the difference is open, is of
// all the drives that are followed: with more of them the evidence up to an earlier one may differ in the
// second decimal of its logarithm.
struct FollowedDrives {
  double alpha = 0.0;
  std::vector<WatchedDrive> drives;
  std::optional<std::size_t> alarm;  // index into `drives`
  std::size_t since = 0;             // with an alarm: the most probable first drive that differs
  // With an alarm, of the evidence at the alarm: what each drive up to then has of it as the first that
  // differs, and the fewest drives running that have kOnsetPart of it.
  std::vector<double> onset_shares;
  DriveRange onset;
  // Most probable first: a first pointer, by derivatives at the moment of the alarm. Where there is a
  // diagnosis, that is the answer.
  std::vector<ChangeShare> causes;
  // The first drive that is diagnosed: of those that are about as probable as `since` the last, since drives
  // before it may be healthy, and would blur what has changed.
  std::size_t diagnosed_since = 0;

  // Whether the evidence stands at 1 / alpha at the last drive alone, which another must confirm.
  bool awaits_another() const {
    return !alarm && !drives.empty() && drives.back().log10_evidence >= -std::log10(alpha);
  }
  // Drives without a window of use.
  std::size_t silent_drives() const {
    return static_cast<std::size_t>(
        std::count_if(drives.begin(), drives.end(), [](const auto& drive) { return drive.windows == 0; }));
  }
};

// A campaign that has a reference is held against what that taught. Errors: those of prepare_as_believed.
Result<FollowedDrives> follow_drives(const DriveCampaign& campaign, const ChangeOptions& change,
                                     const DiagnosisOptions& options, Progress& progress);

// The drives behind the first ones, held against these, which are taken as healthy. Errors: those of
// since_reference too.
inline constexpr std::size_t kDrivesLearntFrom = 12;  // where nothing else is asked for
Result<FollowedDrives> follow_since_first(const DriveCampaign& campaign, std::size_t first,
                                          const ChangeOptions& change, const DiagnosisOptions& options,
                                          Progress& progress);

}  // namespace slipway::gap
