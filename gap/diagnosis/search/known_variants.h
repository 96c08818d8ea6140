#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnosis/search/effect_screening.h"

namespace slipway::gap {

// All ways in which something could be missing that a search knows of, and how they look beside a fit: the
// variants of the library's effects and of the causes from outside, and the places that residuals point to.
// Variants are named by their index, which stays as it is when places are added.
class KnownVariants {
 public:
  // Keeps references to all that it is given.
  KnownVariants(const DriveCampaign& campaign, const WindowModel& model, const NoiseModel& noise,
                const DiscrepancyTerm& discrepancy, const DiagnosisOptions& options);

  const EffectVariant& operator[](std::size_t variant) const { return variants_[variant]; }
  std::size_t count() const { return variants_.size(); }

  // Where effects that act at a place could be at work besides the fit's.
  void add_places_beside(const FittedExplanation& fit);

  // Screens all of them beside the null, and beside the nominal parameters where the null went far from them
  // (`start_from_nominal` then has the estimate there).
  void screen(const FittedExplanation& null);
  std::span<const ScreenedEffect> screened() const { return screened_; }  // best first
  const std::vector<double>* start_from_nominal(std::size_t variant) const;
  // The one of this effect and label; none of a place that was found later.
  const ScreenedEffect* screened_as(const EffectVariant& variant) const;

  // Some of them beside a fit, best first.
  std::vector<ScreenedEffect> beside(const FittedExplanation& fit, std::span<const std::size_t> some) const;

  // In how many ways an effect could be at work, or at how many places that are much different.
  double ways_of(const std::string& effect) const { return ways_.at(effect); }
  // Effects of the library, and causes from outside, that have a way at all.
  std::size_t effects() const { return ways_.size() - outside(); }
  std::size_t outside() const;

 private:
  const DriveCampaign& campaign_;
  const WindowModel& model_;
  const NoiseModel& noise_;
  const DiscrepancyTerm& discrepancy_;
  const DiagnosisOptions& options_;
  std::vector<EffectVariant> variants_;
  std::map<std::string, double> ways_;
  std::vector<ScreenedEffect> screened_;
  std::map<std::size_t, std::vector<double>> start_from_nominal_;
};

}  // namespace slipway::gap
