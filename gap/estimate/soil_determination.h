#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "gap/estimate/soil_parameter.h"

namespace slipway::gap {

enum class Determination {
  kDetermined,    // the data say the parameter: to a quarter of its value at 90 %, and far better than the
                  // prior
  kOneSided,      // they say how great, or how small, it is at most
  kUndetermined,  // what is given is the prior, or where the search ended; or the model does not hold
};
std::string_view name_of(Determination determination);  // "determined", "one_sided", "undetermined"

// In SI and radians.
struct EstimatedParameter {
  SoilParameter parameter = SoilParameter::kN;
  double start = 0.0;
  double value = 0.0;
  std::optional<double> std;  // posterior; nothing where neither data nor prior say anything
  std::optional<double> prior_std;
  // All values that fit the data, the others' priors and no prior of its own, to delta chi^2 = 2.706 (90 %)
  // with every other parameter refitted; an open end is the bound.
  double low = 0.0, high = 0.0;
  bool low_open = false, high_open = false;
  Determination determination = Determination::kUndetermined;
  bool on_bound = false;
  std::string words;  // one sentence
};

// When data are said to determine a parameter.
struct DeterminationOptions {
  double max_of_prior = 0.7;  // posterior over prior deviation: the data halved the variance
  // Half of the 90 % interval over the value, which a traverse planner can still work with.
  double max_half_width = 0.25;
  // Of residuals in deviations: five times what the readings scatter, the model does not hold.
  double max_residual_variance = 25.0;
};

// How a parameter is judged besides its interval.
struct DeterminationGrounds {
  bool says_more = true;  // the posterior is far narrower than the prior, where there is one
  // Of residuals in deviations, see SoilEstimate. Where the model misses the readings by far more than they
  // scatter, no interval around its best miss says what the soil is.
  double residual_variance = 1.0;
  std::optional<double> scale = {};  // what the half width is compared with; nothing: the value
};

// Fills determination and words from value and interval.
void judge(EstimatedParameter& parameter, const DeterminationGrounds& grounds,
           const DeterminationOptions& options = {});

}  // namespace slipway::gap
