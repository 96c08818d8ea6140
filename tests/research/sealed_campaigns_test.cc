#include "research/benchmark/sealed_campaigns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "api/files/campaign/drive_campaign_source.h"
#include "core/progress.h"
#include "research/benchmark/hidden_effect.h"
#include "research/sealed_set/sealed_campaign_folder.h"
#include "tests/campaign/tables.h"

namespace slipway::campaign {
namespace {

std::shared_ptr<const sim::RoverModel> rover() {
  return shipped_catalogue().rovers.at("mer-class");
}

std::vector<std::string> names_hidden_in(const SealedCampaign& sealed) {
  std::vector<std::string> names;
  for (const sim::EffectSetting& effect : sealed.hidden) names.push_back(effect.name);
  return names;
}

TEST(SealedCampaigns, EachEffectIsHiddenAloneOnce) {
  std::map<std::string, int> alone;
  int controls = 0, pairs = 0;
  for (const SealedCampaign& sealed : sealed_campaigns("each", 3, rover())) {
    const auto names = names_hidden_in(sealed);
    controls += names.empty();
    pairs += names.size() == 2;
    if (names.size() == 1) ++alone[names[0]];
  }
  for (const std::string_view name : hidden_effects()) EXPECT_EQ(alone[std::string(name)], 1) << name;
  EXPECT_EQ(alone.size(), hidden_effects().size());
  EXPECT_EQ(controls, 4);
  EXPECT_EQ(pairs, 3);
}

TEST(SealedCampaigns, TheirTablesCanBeDriven) {
  std::set<std::string> names;
  for (const std::string_view set : sealed_sets())
    for (const std::uint64_t seed : {1U, 2U, 3U})
      for (const SealedCampaign& sealed : sealed_campaigns(set, seed, rover())) {
        for (const DriveTable* table : {&sealed.driven, &sealed.believed})
          for (const Fault& fault : faults_of(*table))
            ADD_FAILURE() << sealed.name << fault.pointer << ": " << fault.message;
        EXPECT_TRUE(sim::faults_of(sealed.hidden).empty()) << sealed.name;
        names.insert(sealed.name);
      }
  EXPECT_EQ(names.size(), 23U);
}

TEST(SealedCampaigns, WhatIsBelievedTellsNothingOfWhatIsHidden) {
  for (const SealedCampaign& sealed : sealed_campaigns("each", 4, rover())) {
    EXPECT_TRUE(sealed.believed.effects.empty());
    EXPECT_EQ(sealed.believed.rover, rover());
    EXPECT_EQ(sealed.believed.soils.size(), 1U);
    for (const TableTerrain& terrain : sealed.believed.terrains) EXPECT_EQ(terrain.soil_map, nullptr);
    const sim::Soil& told = sealed.believed.soils.at("nominal").mean;
    const sim::Soil& truth = sealed.driven.soils.at("nominal").mean;
    const auto ratio_is_near = [&](double told_value, double true_value) {
      EXPECT_NEAR(told_value / true_value, 1.0, sealed.nominal == "true" ? 1e-12 : 0.2501) << sealed.name;
    };
    ratio_is_near(told.pressure.k_phi, truth.pressure.k_phi);
    ratio_is_near(told.cohesion_pa, truth.cohesion_pa);
    ratio_is_near(told.shear_modulus_x_m, truth.shear_modulus_x_m);
  }
}

TEST(SealedCampaigns, ASoftPatchIsWeakerSoilInItsPlaceAlone) {
  int patches = 0;
  for (const SealedCampaign& sealed : sealed_campaigns("each", 5, rover())) {
    EXPECT_EQ(sealed.place.has_value(), names_hidden_in(sealed) == std::vector<std::string>{"soft_patch"});
    if (!sealed.place) continue;
    ++patches;
    const TableTerrain& terrain = sealed.driven.terrains[0];
    EXPECT_TRUE(terrain.soil_map->soil_at(sealed.place->x_m, sealed.place->y_m));
    EXPECT_FALSE(
        terrain.soil_map->soil_at(sealed.place->x_m, sealed.place->y_m + 1.1 * sealed.place->radius_m));
    EXPECT_LT(sealed.driven.soils.at("soft").mean.pressure.k_phi,
              sealed.driven.soils.at("nominal").mean.pressure.k_phi);
  }
  EXPECT_EQ(patches, 1);
}

TEST(SealedCampaigns, AnotherSeedHidesOtherThings) {
  const auto key_of = [](const SealedCampaign& sealed) {
    std::string key = sealed.name + sealed.soil + sealed.nominal;
    for (const sim::EffectSetting& effect : sealed.hidden)
      for (const auto& [name, value] : effect.parameters) key += effect.name + name + std::to_string(value);
    return key + std::to_string(sealed.believed.soils.at("nominal").mean.pressure.k_phi);
  };
  const auto first = sealed_campaigns("each", 6, rover()), again = sealed_campaigns("each", 6, rover()),
             other = sealed_campaigns("each", 7, rover());
  int alike = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(key_of(first[i]), key_of(again[i]));
    alike += key_of(first[i]) == key_of(other[i]);
  }
  EXPECT_EQ(alike, 0);
}

std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream stream(entry.path(), std::ios::binary);
    files[std::filesystem::relative(entry.path(), folder).string()] = {std::istreambuf_iterator<char>(stream),
                                                                       {}};
  }
  return files;
}

class GivenUp final : public Progress {
 public:
  void report(std::string_view /*stage*/, double /*fraction*/) override {}
  bool cancelled() const override { return true; }
};

Result<void> make(const std::filesystem::path& folder, std::uint64_t seed, std::size_t threads,
                  Progress& progress) {
  std::vector<SealedCampaign> campaigns = sealed_campaigns("smoke", seed, rover());
  for (SealedCampaign& sealed : campaigns) {  // two drives each are enough here
    sealed.driven.entries.resize(1);
    sealed.believed.entries.resize(1);
  }
  return api::make_sealed_folder(
      {folder, "smoke", seed}, campaigns, threads, [](const std::string&, std::size_t, std::size_t) {},
      progress);
}

TEST(SealedSet, GoesOnAfterAnInterruptionWithTheSameBytes) {
  NoProgress patience;
  GivenUp impatience;
  const auto whole = empty_folder("sealed_whole"), parts = empty_folder("sealed_parts");
  ASSERT_TRUE(make(whole, 7, 1, patience));
  const auto interrupted = make(parts, 7, 2, impatience);
  ASSERT_FALSE(interrupted);
  EXPECT_EQ(interrupted.error().code, ErrorCode::kCancelled);
  EXPECT_FALSE(std::filesystem::exists(parts / "answers.json"));
  ASSERT_TRUE(make(parts, 7, 2, patience));
  EXPECT_EQ(files_in(whole), files_in(parts));
  EXPECT_TRUE(make(whole, 7, 2, patience)) << "all is made already";
  const auto campaign = api::load_drive_campaign(whole / "d01", shipped_catalogue());
  ASSERT_TRUE(campaign);
  EXPECT_EQ(campaign->drives.size(), 2U);
  EXPECT_EQ(campaign->drives[1].repeat_of, campaign->drives[0].id);
}

TEST(SealedSet, LeavesAloneWhatItDidNotMake) {
  NoProgress patience;
  const auto folder = empty_folder("sealed_foreign");
  ASSERT_TRUE(make(folder, 7, 1, patience));
  const auto before = files_in(folder);
  const auto other = make(folder, 8, 1, patience);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, ErrorCode::kConflict);
  std::filesystem::remove(folder / "made.json");
  EXPECT_FALSE(make(folder, 7, 1, patience));
  EXPECT_EQ(files_in(folder).size(), before.size() - 1);
}

}  // namespace
}  // namespace slipway::campaign
