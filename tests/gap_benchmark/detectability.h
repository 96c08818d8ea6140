#pragma once

#include <string>

#include "sealed_campaign.h"

namespace slipway::gap_benchmark {

// How far the mean readings with the hidden causes are from those without, as squared Mahalanobis distances
// over all stretches of all drives. The covariance is that of the sensors and of the soil's scatter from
// drive to drive and along a drive. Half of a distance is the log evidence that a diagnosis can expect at
// most, if it knows laws, sizes and places of the causes beforehand. What may be re-tuned takes a part of it.
// To first order in the parameters.
struct Detectability {
  double parameters_known = 0.0;
  double retuned_as_drawn = 0.0;     // within the widths by which the campaigns' soils and closures vary
  double retuned_as_believed = 0.0;  // within the diagnosis's prior, which is wider
};
Detectability detectability(const SealedCampaign& campaign);

// detectability.csv: campaign, then the members.
std::string detectability_header();
std::string detectability_row(const std::string& campaign, const Detectability& detectability);

}  // namespace slipway::gap_benchmark
