#include "gap/diagnosis/search/known_variants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "gap/diagnosis/search/prepared_campaign.h"
#include "tests/gap/practice_drives.h"

namespace slipway::gap {
namespace {

class KnownVariantsOfSomeDrives : public ::testing::Test {
 protected:
  KnownVariantsOfSomeDrives() {
    auto prepared = prepare(campaign_, options_, progress_);
    EXPECT_TRUE(prepared);
    prepared_ = std::move(*prepared);
  }

  KnownVariants known() const {
    return {campaign_, *prepared_.model, *prepared_.noise, prepared_.discrepancy, options_};
  }
  static std::string name_of(const EffectVariant& v) { return v.effect + " " + v.label; }

  const DriveCampaign campaign_ = some_drives(6);
  const DiagnosisOptions options_;
  NoProgress progress_;
  PreparedCampaign prepared_;
};

TEST_F(KnownVariantsOfSomeDrives, KeepTheirIndexWherePlacesAreAdded) {
  KnownVariants variants = known();
  variants.screen(*prepared_.null);
  const std::size_t before = variants.count();
  std::vector<std::string> names;
  for (std::size_t v = 0; v < before; ++v) names.push_back(name_of(variants[v]));
  const std::size_t screened = variants.screened().size();
  variants.add_places_beside(*prepared_.null);
  ASSERT_GT(variants.count(), before);
  for (std::size_t v = 0; v < before; ++v) EXPECT_EQ(name_of(variants[v]), names[v]);
  EXPECT_EQ(variants.screened().size(), screened);
  EXPECT_EQ(variants.screened_as(variants[before]), nullptr) << "it was found later";
  const ScreenedEffect* const first = variants.screened_as(variants[0]);
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(first->variant, 0U);
  EXPECT_GE(variants.ways_of("soft_patch"), 1.0);

  const std::vector<std::size_t> some{before, 0, 3};
  std::vector<std::size_t> seen;
  for (const ScreenedEffect& s : variants.beside(*prepared_.null, some)) seen.push_back(s.variant);
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(seen, (std::vector<std::size_t>{0, 3, before}));
}

TEST_F(KnownVariantsOfSomeDrives, AreScreenedAtTheNominalParametersTooWhereTheNullWentFar) {
  FittedExplanation near = *prepared_.null;
  near.x = near.hypothesis.neutral();
  KnownVariants beside_near = known();
  beside_near.screen(near);
  EXPECT_EQ(beside_near.start_from_nominal(0), nullptr);

  FittedExplanation far = near;
  far.x[0] += (options_.search.max_linear_shift + 0.5) * far.hypothesis.parameters()[0].std;
  KnownVariants variants = known();
  variants.screen(far);
  for (std::size_t v = 0; v < variants.count(); ++v) {
    ASSERT_NE(variants.start_from_nominal(v), nullptr);
    EXPECT_NE((*variants.start_from_nominal(v))[0], far.x[0]) << "from the nominal soil";
  }
  const auto screened = variants.screened();
  EXPECT_TRUE(std::is_sorted(screened.begin(), screened.end(), [](const auto& a, const auto& b) {
    return a.gain > b.gain;
  })) << "best first";
}

TEST_F(KnownVariantsOfSomeDrives, CountEffectsAndCausesFromOutsideApart) {
  const KnownVariants all = known();
  EXPECT_GT(all.effects(), 10U);
  EXPECT_GT(all.outside(), 5U);
  DiagnosisOptions library_alone = options_;
  library_alone.search.outside = false;
  const KnownVariants library(campaign_, *prepared_.model, *prepared_.noise, prepared_.discrepancy,
                              library_alone);
  EXPECT_EQ(library.outside(), 0U);
  EXPECT_EQ(library.effects(), all.effects());
}

}  // namespace
}  // namespace slipway::gap
