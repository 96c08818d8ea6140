#pragma once

namespace slipway::gap {

// The probability that an effect is at work, of what the search says of it: a logistic in the logit of its
// marginal probability and the logarithm of the share of the held-out gap that it closes. The most
// likely one on answers to sealed campaigns whose hidden effects are known
// (data/validation/sealed_levels_marginals.csv, with their seeds). 0 of an
// effect that closes nothing: it tells no held-out drive better.
struct Calibration {
  double constant, by_log_odds, by_log_share;
  double operator()(double marginal, double share) const;
};
const Calibration& calibration(bool with_reference);

}  // namespace slipway::gap
