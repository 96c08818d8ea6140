#include <fmt/format.h>

#include <array>

#include "gap/diagnosis/model/measured_rates.h"
#include "gap/diagnosis/model/outside_cause_rows.h"
#include "gap/diagnosis/model/window_model.h"

namespace slipway::gap {
namespace {

using Values = OutsideValues;

// Only where rates were measured does it differ from a wheel that turns slower than commanded, which the
// library has.
std::vector<sim::EffectVariant> slipping_rims(const DriveCampaign& campaign) {
  std::vector<sim::EffectVariant> all;
  if (!measured_rate_shares(campaign)) return all;
  for (std::size_t k = 0; k < campaign.rover->wheels.size(); ++k)
    all.push_back(outside_variant({{.field = "share", .std = 0.2, .lowest = 0.0, .highest = 0.95}},
                                  campaign.rover->wheels[k].name, {{wheel_field(k), 1.0}}));
  return all;
}

void slip_rim(const Values& values, ModelState& state) {
  for (const std::size_t k : wheels_in(values)) state.rover.wheels[k].rate_share *= 1.0 - values.at("share");
}

std::string rim_words(const Values& v, const DriveCampaign& campaign) {
  return fmt::format("the rim of {} turns {:.1f} % slower than its measured rate, as where a hub slips",
                     names_of_wheels(*campaign.rover, wheels_in(v)), 100.0 * v.at("share"));
}

constexpr std::array kRoverRows{OutsideCause{.name = "rim_slip",
                                             .form = "sensor",
                                             .entry = "wheel_rate",
                                             .depends = "constant",
                                             .unit = "1",
                                             .variants = &slipping_rims,
                                             .act = &slip_rim,
                                             .words = &rim_words}};

}  // namespace

std::span<const OutsideCause> outside_rover_rows() {
  return kRoverRows;
}

}  // namespace slipway::gap
