#include "gap/diagnosis/decide/adequacy.h"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "gap/diagnosis/search/diagnosis_options.h"

namespace slipway::gap {

Adequacy adequacy_of(const SearchRecord& record, std::size_t fit) {
  Adequacy adequacy;
  const auto windows = static_cast<double>(record.windows);
  const double rms = adequacy.held_out_rms = record.fits[fit].held_out_rms;
  const double off =
      DiscrepancyOptions{}.form_imprecision * std::max(0.0, record.fits.front().held_out_rms - rms);
  if (record.windows > 0)
    adequacy.held_out_p = boost::math::gamma_q(0.5 * windows, 0.5 * windows * rms * rms / (1.0 + off * off));
  // What a reference taught is believed as it is: its own drives told of the scatter and of the parameters.
  if (record.with_reference) return adequacy;
  double square = 0.0;
  int terms = 0;
  for (const SearchRecord::Shift& shift : record.fits[fit].shifts) {
    if (!shift.has_far_ends) continue;
    square += shift.deviations * shift.deviations;
    ++terms;
    if (std::abs(shift.deviations) > std::abs(adequacy.deviations)) {
      adequacy.deviations = shift.deviations;
      adequacy.furthest = shift.parameter;
    }
  }
  for (const double above : record.scatter_deviations) {
    const double deviations = std::max(0.0, above);
    square += deviations * deviations;
    ++terms;
    if (deviations <= std::abs(adequacy.deviations)) continue;
    adequacy.deviations = deviations;
    adequacy.furthest.clear();
  }
  if (terms > 0) adequacy.conflict_p = boost::math::gamma_q(0.5 * terms, 0.5 * square);
  return adequacy;
}

}  // namespace slipway::gap
