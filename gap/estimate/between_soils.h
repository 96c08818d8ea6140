#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "gap/estimate/ensemble_sampler.h"

namespace slipway::gap {

// What the tests of one soil alone say of some numbers: samples, a row each, of a posterior whose prior was
// flat in these numbers.
struct SoilSamples {
  std::string name;
  Eigen::MatrixXd values;
};

// Mean, standard deviation and correlation of the numbers of one soil.
struct NumbersOfSoil {
  Eigen::VectorXd mean, std;
  Eigen::MatrixXd correlation;
};

// Of samples, a row each; `weights` add up to 1 and are all the same where there are none.
NumbersOfSoil numbers_of(const Eigen::MatrixXd& samples, const Eigen::VectorXd& weights = {});

// A number that differs from soil to soil.
struct BetweenNumber {
  double lowest = 0.0, highest = 1.0;  // which a soil can have
  double usual_spread = 0.25;          // how much soils may differ before any was tested, see between_soils
};

// A standard deviation with its 90 % interval.
struct SpreadInterval {
  double median = 0.0, low = 0.0, high = 0.0;
};

struct BetweenSoils {
  NumbersOfSoil next;              // of a soil that was not tested, all that is not known of the soils in it
  Eigen::MatrixXd next_samples;    // of such soils, a row each
  Eigen::VectorXd mean, mean_std;  // of all soils, and how surely that is known
  std::vector<SpreadInterval> spread;    // of each number between soils
  SpreadInterval correlation;            // of the first two; 0 where there is one
  std::vector<NumbersOfSoil> of_tested;  // each tested soil's, by its own tests and those of the others
};

// A hierarchy of soils: the numbers of each are normal about a mean, with deviations and a correlation that
// are the same for all soils and are found with them [Gelman et al. 2013, Bayesian Data Analysis, chapter 5].
// Before the tests the mean is uniform between the bounds, each deviation half-normal of scale usual_spread,
// and every correlation matrix as likely as another [Lewandowski, Kurowicka & Joe 2009]. Each soil enters by
// its samples [Hogg, Myers & Bovy 2010, Astrophys. J. 725, 2166]. A next soil is cut at the bounds.
//
// Errors: invalid_request without soils or with samples of another size; cancelled.
Result<BetweenSoils> between_soils(std::span<const SoilSamples> soils, std::span<const BetweenNumber> numbers,
                                   const EnsembleOptions& options, Progress& progress);

}  // namespace slipway::gap
