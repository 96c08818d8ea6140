#pragma once

#include <span>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/estimate/least_squares.h"
#include "gap/estimate/soil_estimation_options.h"
#include "gap/estimate/soil_observation.h"
#include "gap/estimate/tested_rigs.h"

namespace slipway::gap {

// Searches within a search: heard when it is given up, but not reported.
class Within final : public Progress {
 public:
  explicit Within(const Progress& outer) : outer_(outer) {}
  void report(std::string_view /*stage*/, double /*fraction*/) override {}
  bool cancelled() const override { return outer_.cancelled(); }

 private:
  const Progress& outer_;
};

// The least-squares problem of some axes: their unknowns with priors and bounds, and the residuals of the
// readings in deviations. Several of them may share one SoilObservations, which keeps where wheels stood.
class SoilSearch {
 public:
  // `soils`: the start and the centre of the priors, one for each of the data's. `deviations`: of axes' own
  // priors in the place of the options'; 0, or none: the options'.
  SoilSearch(const SoilData& data, std::span<const sim::SoilDistribution> soils,
             std::vector<FreeParameter> axes, const SoilEstimationOptions& options,
             SoilObservations& observations, std::vector<double> deviations = {});

  const TestedRigs& rigs() const { return rigs_; }
  std::span<const Unknown> unknowns() const { return unknowns_; }
  std::size_t priors() const;
  ResidualFunction residuals() const;
  // Of every reading at x; false where the model has none.
  bool predict(std::span<const double> x, std::span<double> values) const;
  // What is believed of an axis's coordinate before the data; nothing without priors.
  std::optional<double> prior_std(std::size_t axis) const;

  // From the soils, and from elsewhere where that ends poorly.
  Result<LeastSquaresFit> fit(const LeastSquaresOptions& options, Progress& progress) const;

 private:
  Unknown unknown_of(std::size_t axis) const;
  std::vector<Unknown> drawn_start(int start) const;

  std::span<const sim::SoilDistribution> soils_;
  const SoilEstimationOptions& options_;
  SoilObservations& observations_;
  std::vector<double> deviations_;
  TestedRigs rigs_;
  std::vector<Unknown> unknowns_;
};

// The spread of one soil along an axis, as a deviation of the coordinate; 0 where it has none.
double own_spread(const sim::SoilDistribution& soil, const TestedRigs& rigs, std::size_t axis);

// What is neither free nor stated of each soil and yet uncertain, and the deviations of its coordinates: k,
// n, cohesion, friction angle and K by what the priors are, the soil's own spread or that of soils of all
// kinds; c1 and c2 by the soil's own or, where it has none, by kClosureSpread.
constexpr double kClosureSpread = 0.15;  // of c1 and c2 among published sands
struct Assumed {
  FreeParameter parameter;
  double std = 0.0;
};
std::vector<Assumed> assumed_of(const SoilData& data, std::span<const sim::SoilDistribution> soils,
                                double width_m, std::span<const FreeParameter> free,
                                const SoilEstimationOptions& options);

}  // namespace slipway::gap
