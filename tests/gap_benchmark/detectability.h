#pragma once

#include <string>

#include "sealed_campaign.h"

namespace slipway::gap_benchmark {

// How far the mean readings with the hidden causes are from those without, as squared Mahalanobis distances
// over all stretches of all drives in which every changed world has a balance. The covariance is that of the
// sensors and of the soil's scatter; what scatters from drive to drive is shared by a drive's stretches, what
// scatters along a drive counts as independent from stretch to stretch. A diagnosis that knew the causes'
// laws, sizes and places beforehand could expect half of a distance as its log evidence. What may be re-tuned
// takes a part of it, to first order in the parameters: soil, closures, height of the centre of mass and the
// motors' torque constant. Late headings and sinkages read from a track's bottom are not among them.
struct Detectability {
  double parameters_known = 0.0;
  double retuned_as_drawn = 0.0;  // within the widths by which the campaigns' soils and closures vary
  // Within the diagnosis's prior: wider for the soil, with the shear modulus across apart from that along,
  // without a heap before the rim and another shape of the stress.
  double retuned_as_believed = 0.0;
};
Detectability detectability(const SealedCampaign& campaign);

// detectability.csv: campaign, then the members.
std::string detectability_header();
std::string detectability_row(const std::string& campaign, const Detectability& detectability);

}  // namespace slipway::gap_benchmark
