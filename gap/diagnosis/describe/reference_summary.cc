#include "gap/diagnosis/describe/reference_summary.h"

#include <cmath>

#include "gap/diagnosis/model/reference_belief.h"

namespace slipway::gap {

ReferenceSummary reference_summary(const PreparedCampaign& prepared, const DriveCampaign& campaign) {
  const ReferenceBelief& belief = *campaign.reference;
  ReferenceSummary summary{belief.campaign, belief.fingerprint, belief.drives, belief.windows, {}};
  const LearntDifference& learnt = *prepared.model->learnt();
  std::vector<double> square(channel_count(), 0.0), open = square, count = square;
  for (std::size_t w = 0; w < prepared.windows.size(); ++w)
    for (std::size_t i = 0; prepared.model->used(w) && i < prepared.windows[w].observations.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(prepared.model->offset(w) + i);
      const auto c = static_cast<std::size_t>(prepared.windows[w].observations[i].channel);
      square[c] += learnt.offset[row] * learnt.offset[row];
      open[c] += learnt.left.row(row).squaredNorm();
      count[c] += 1.0;
    }
  for (std::size_t c = 0; c < count.size(); ++c)
    if (count[c] > 0.0)
      summary.channels.push_back(
          {static_cast<Channel>(c), std::sqrt(square[c] / count[c]), std::sqrt(open[c] / count[c])});
  return summary;
}

}  // namespace slipway::gap
