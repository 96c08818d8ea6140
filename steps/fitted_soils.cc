#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "steps/belief_fit.h"

namespace slipway::steps {
namespace {

// The soil on units whose slip over climbs is nearest to the class's median: what is predicted on mean soils.
const FittedSoil& median_soil(const BeliefFit& fit, const FittedClass& of) {
  std::vector<double> distance(fit.soils.size(), 0.0);
  for (std::size_t c = 0; c < kComparedClimbs_deg.size(); ++c) {
    std::vector<std::size_t> order(fit.soils.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return fit.soils[a].slips[c] < fit.soils[b].slips[c];
    });
    double sum = 0.0, median = 0.0;
    for (const std::size_t k : order) {
      median = fit.soils[k].slips[c];
      if ((sum += of.shares[k]) >= 0.5) break;
    }
    for (std::size_t k = 0; k < distance.size(); ++k) distance[k] += std::abs(fit.soils[k].slips[c] - median);
  }
  std::size_t best = 0;
  for (std::size_t k = 0; k < distance.size(); ++k)
    if (!fit.soils[k].in_patches && distance[k] < distance[best]) best = k;
  return fit.soils[best];
}

sim::SoilDistribution soil_of(const FittedSoil& fitted, const std::string& source,
                              const BeliefFitOptions& options) {
  sim::SoilDistribution soil;
  soil.name = fitted.name;
  soil.summary = fmt::format("{} ground of Gale crater: slips by {:.1f} % on the level, {:.0f} % at 8 deg",
                             fitted.in_patches ? "Loose" : "Firm", 100.0 * fitted.level_slip,
                             100.0 * fitted.slip_at_8_deg);
  soil.source = source;
  soil.assumed = {
      "which of the soils with this slip it is: slip alone tells stiffness, strength and shear apart "
      "poorly",
      "density_kg_m3", "c1", "c2"};
  soil.mean = fitted.soil;
  soil.correlation_length_m = options.patch_m;
  return soil;
}

}  // namespace

std::vector<sim::SoilDistribution> as_soils(const BeliefFit& fit, const BeliefFitOptions& options,
                                            const std::string& source) {
  // How far the slip of a patch is from its soil's: the part of a step's noise that goes with the slip.
  constexpr double kSlipError = 0.2;
  // The logarithms of shares differ by about this between the sols before 583 and Marias Pass.
  constexpr double kSharesSpread = 1.0;
  // The share of loose steps differs between Curiosity's sols with a coefficient of variation of some 2.4:
  // sqrt(ln(1 + 2.4^2)).
  constexpr double kPatchesSpread = 1.4;
  std::vector<sim::SoilDistribution> soils;
  for (const FittedSoil& each : fit.soils) soils.push_back(soil_of(each, source, options));
  for (const FittedClass& of : fit.classes) {
    sim::SoilDistribution belief = soil_of(median_soil(fit, of), source, options);
    belief.name = of.name;
    belief.summary = of.summary;
    belief.assumed = {
        "mean: the soil whose slip is nearest to the median over climbs; predictions on mean soils alone",
        "slip_error: the part of a step's scatter that goes with its slip",
        "alternatives_spread: places differ in their shares about as much as Marias Pass does "
        "from the plains before it",
        "patches_spread: units differ in their share of patches as sols do"};
    belief.shares = {0.0, 0.0, 1.0};
    belief.slip_error = kSlipError;
    belief.drawn_apart = false;
    belief.alternatives_by = sim::AlternativesBy::kUnit;
    belief.alternatives_spread = kSharesSpread;
    for (std::size_t k = 0; k < fit.soils.size(); ++k) {
      const double share = std::round(1e5 * of.shares[k]) / 1e5;
      if (share <= 0.0) continue;
      belief.alternatives.push_back({fit.soils[k].name,
                                     std::make_shared<const sim::SoilDistribution>(soils[k]), share, share,
                                     fit.soils[k].in_patches});
    }
    if (std::any_of(belief.alternatives.begin(), belief.alternatives.end(),
                    [](const sim::SoilAlternative& each) { return each.in_patches; }))
      belief.patches_spread = kPatchesSpread;
    soils.push_back(std::move(belief));
  }
  return soils;
}

}  // namespace slipway::steps
