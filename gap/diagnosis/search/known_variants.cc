#include "gap/diagnosis/search/known_variants.h"

#include <algorithm>

#include "gap/diagnosis/model/measured_rates.h"
#include "gap/diagnosis/model/outside_cause.h"
#include "gap/diagnosis/search/soft_patch_search.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::gap {
namespace {

// The fit that no iteration has moved from the nominal parameters.
FittedExplanation at_nominal(const FittedExplanation& null, const WindowModel& model, const NoiseModel& noise,
                             const DiagnosisOptions& options) {
  FitOptions untouched = options.fit;
  untouched.max_iterations = 0;
  return fit_explanation(null.hypothesis, model, noise, null.hypothesis.neutral(), untouched,
                         options.search.threads);
}

}  // namespace

KnownVariants::KnownVariants(const DriveCampaign& campaign, const WindowModel& model, const NoiseModel& noise,
                             const DiscrepancyTerm& discrepancy, const DiagnosisOptions& options)
    : campaign_(campaign),
      model_(model),
      noise_(noise),
      discrepancy_(discrepancy),
      options_(options),
      variants_(effect_variants(*campaign.rover, options.search.withheld)) {
  if (options.search.outside) {
    const std::vector<EffectVariant> outside = outside_variants(campaign);
    variants_.insert(variants_.end(), outside.begin(), outside.end());
  }
  bound_by_measured_rates(campaign, variants_);
  for (const EffectVariant& v : variants_) ++ways_[v.effect];
}

void KnownVariants::add_places_beside(const FittedExplanation& fit) {
  for (const sim::Effect& effect : sim::effect_catalogue()) {
    const auto& withheld = options_.search.withheld;
    if (effect.variant_at == nullptr ||
        std::find(withheld.begin(), withheld.end(), effect.name) != withheld.end())
      continue;
    const PatchSearch patches =
        search_soft_patches(effect, campaign_, model_, noise_, fit, options_.soft_patch);
    variants_.insert(variants_.end(), patches.variants.begin(), patches.variants.end());
    ways_[std::string(effect.name)] = static_cast<double>(patches.looks);
  }
}

void KnownVariants::screen(const FittedExplanation& null) {
  const auto all_beside = [&](const FittedExplanation& fit) {
    return screen_effects(campaign_, model_, noise_, fit, discrepancy_, variants_, options_.discrepancy,
                          options_.search.threads);
  };
  screened_ = all_beside(null);
  if (!went_far(null, options_.search.max_linear_shift)) return;
  for (const ScreenedEffect& f : all_beside(at_nominal(null, model_, noise_, options_))) {
    start_from_nominal_[f.variant] = f.start;
    for (ScreenedEffect& s : screened_)
      if (s.variant == f.variant) s.gain = std::max(s.gain, f.gain);
  }
  std::stable_sort(screened_.begin(), screened_.end(),
                   [](const ScreenedEffect& a, const ScreenedEffect& b) { return a.gain > b.gain; });
}

const std::vector<double>* KnownVariants::start_from_nominal(std::size_t variant) const {
  const auto start = start_from_nominal_.find(variant);
  return start == start_from_nominal_.end() ? nullptr : &start->second;
}

const ScreenedEffect* KnownVariants::screened_as(const EffectVariant& variant) const {
  const auto same = [&](const ScreenedEffect& s) {
    return variants_[s.variant].effect == variant.effect && variants_[s.variant].label == variant.label;
  };
  const auto found = std::find_if(screened_.begin(), screened_.end(), same);
  return found == screened_.end() ? nullptr : &*found;
}

std::vector<ScreenedEffect> KnownVariants::beside(const FittedExplanation& fit,
                                                  std::span<const std::size_t> some) const {
  std::vector<EffectVariant> variants;
  for (const std::size_t v : some) variants.push_back(variants_[v]);
  std::vector<ScreenedEffect> found = screen_effects(campaign_, model_, noise_, fit, discrepancy_, variants,
                                                     options_.discrepancy, options_.search.threads);
  for (ScreenedEffect& s : found) s.variant = some[s.variant];
  return found;
}

std::size_t KnownVariants::outside() const {
  return static_cast<std::size_t>(
      std::count_if(ways_.begin(), ways_.end(), [](const auto& ways) { return is_outside(ways.first); }));
}

}  // namespace slipway::gap
