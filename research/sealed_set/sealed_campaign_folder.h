#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "research/benchmark/sealed_campaigns.h"

namespace slipway::api {

// A folder of campaigns to judge the diagnosis by: a drive-campaign/1 of its own in each NAME/, made.json
// that says from which set and seed, and answers.json, the key. Nothing in NAME/ says what is hidden.
struct SealedSet {
  std::filesystem::path path;
  std::string set;
  std::uint64_t seed = 1;
};

// Reported after each campaign: its name, how many drives it has, how many of how many campaigns are made.
using SealedTaker = std::function<void(const std::string& name, std::size_t drives, std::size_t made)>;

// Makes what is not made yet of these campaigns, which are the folder's set of its seed. A campaign's
// campaign.json is its last file, answers.json that of all. Drives that slid off, tipped over or have no
// answer are left out. Errors: conflict where the folder holds anything else than campaigns of this set, seed
// and version; unwritable_file; cancelled, after which the same call goes on.
Result<void> make_sealed_folder(const SealedSet& folder, std::span<const campaign::SealedCampaign> campaigns,
                                std::size_t threads, const SealedTaker& taker, Progress& progress);

}  // namespace slipway::api
