#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gap/estimate/free_parameter.h"

namespace slipway::gap {

enum class Determination {
  kDetermined,    // the data say the parameter: to a quarter of its value at 90 %, and far better than the
                  // prior
  kOneSided,      // they say how great, or how small, it is at most
  kUndetermined,  // what is given is the prior, or where the search ended; or the model does not hold
};
std::string_view name_of(Determination determination);  // "determined", "one_sided", "undetermined"

// An end that is open is the bound.
struct ParameterRange {
  double low = 0.0, high = 0.0;
  bool low_open = false, high_open = false;
};

// In SI and radians, or in the boundary's unit of what is none of the seven.
struct EstimatedParameter {
  FreeParameter parameter = SoilParameter::kN;
  double start = 0.0;
  double value = 0.0;
  std::optional<double> std;  // posterior; nothing where neither data nor prior say anything
  std::optional<double> prior_std;
  // All values that fit the data, the others' priors and no prior of its own, to delta chi^2 = 2.706 (90 %)
  // with every other parameter refitted; an open end is the bound.
  double low = 0.0, high = 0.0;
  bool low_open = false, high_open = false;
  // The same where what is neither free nor stated varies too, as far as it is uncertain, and what that is;
  // only of what would be determined otherwise.
  std::optional<ParameterRange> with_assumed;
  std::vector<std::string> assumed;
  Determination determination = Determination::kUndetermined;
  bool on_bound = false;
  std::string words;  // one sentence
};

// When data are said to determine a parameter.
struct DeterminationOptions {
  double max_of_prior = 0.7;  // posterior over prior deviation: the data halved the variance
  // How far the ends of the 90 % interval are from the value, over it: what a traverse planner can still
  // work with.
  double max_half_width = 0.25;
  // The model holds where chi-square of the readings is no greater than what so many of a thousand sets of
  // readings with the stated noise exceed, given the model.
  double false_alarms_in_1000 = 1.0;
  // Readings beside those that the free parameters take up: with fewer nothing says whether the model holds.
  std::size_t min_spare_readings = 3;
};

// How a parameter is judged besides its interval and what it would be if the assumptions varied.
struct DeterminationGrounds {
  bool says_more = true;  // the posterior is far narrower than the prior, where there is one
  // Whether the residuals are as the readings' noise says. Where they are not, no interval around the least
  // miss says what the soil is.
  bool model_holds = true;
  std::optional<std::size_t> spare_readings = {};  // nothing: enough
  std::optional<double> scale = {};                // what the half width is compared with; nothing: the value
};

// The greatest variance of residuals, in deviations, at which the model is said to hold with so many degrees
// of freedom: a quantile of chi-square over them [Wilson & Hilferty 1931].
double max_residual_variance(std::size_t degrees_of_freedom, const DeterminationOptions& options = {});

// Whether value and interval alone would be called determined, or one-sided.
Determination said_by(const ParameterRange& range, double value, const DeterminationGrounds& grounds,
                      const DeterminationOptions& options = {});
// Fills determination and words.
void judge(EstimatedParameter& parameter, const DeterminationGrounds& grounds,
           const DeterminationOptions& options = {});

}  // namespace slipway::gap
