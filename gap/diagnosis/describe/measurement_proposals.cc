#include "gap/diagnosis/describe/measurement_proposals.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>

#include "gap/diagnosis/model/nuisance_catalogue.h"
#include "gap/diagnosis/search/linear_gain.h"

namespace slipway::gap {
namespace {

using Kinds = std::vector<NuisanceKind>;

// What could be measured apart from drives, the least work first.
const std::array<Kinds, 6>& measurements() {
  static const std::array<Kinds, 6> all{
      {{NuisanceKind::kMotor},
       {NuisanceKind::kSensor},
       {NuisanceKind::kSoil},
       {NuisanceKind::kMotor, NuisanceKind::kSoil},
       {NuisanceKind::kSoil, NuisanceKind::kClosure},
       {NuisanceKind::kMotor, NuisanceKind::kSoil, NuisanceKind::kClosure}}};
  return all;
}

bool among(const Kinds& kinds, NuisanceKind kind) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

// Directions that re-tuning takes where parameters of these kinds are known, as those that were measured are.
Eigen::MatrixXd taken_beside(const FittedExplanation& null, const Kinds& known) {
  std::vector<Eigen::Index> left;
  const auto parameters = null.hypothesis.parameters();
  for (std::size_t p = 0; p < null.hypothesis.nuisance_count(); ++p)
    if (parameters[p].is_told_by_drives() && !among(known, *parameters[p].kind))
      left.push_back(static_cast<Eigen::Index>(p));
  return spanned_by(null.white_jacobian(Eigen::all, left));
}

// An effect that was not surely seen in any of its ways, with the whitened response of each at its usual
// size.
struct Unseen {
  double deviations = 0.0;
  std::vector<Eigen::VectorXd> responses;
};

double most_visible(const Unseen& effect, const Eigen::MatrixXd& taken) {
  double most = 0.0;
  for (const Eigen::VectorXd& response : effect.responses)
    most = std::max(most, (response - taken * (taken.transpose() * response)).norm());
  return most;
}

std::map<std::string, Unseen> unseen_effects(const ExplanationSearch& search, const Whitening& whitened,
                                             const DescriptionOptions& options) {
  std::map<std::string, Unseen> effects;
  std::set<std::string> seen;
  for (const ScreenedVariant& s : search.screened)
    if (s.visibility >= options.surely_seen) seen.insert(s.variant.effect);
  for (const ScreenedVariant& s : search.screened)
    if (!seen.contains(s.variant.effect) && s.columns.cols() > 0)
      effects[s.variant.effect].responses.push_back(whitened(s.columns.col(0)));
  const Eigen::MatrixXd taken = taken_beside(search.fits[0], {});
  for (auto& [name, effect] : effects) effect.deviations = most_visible(effect, taken);
  std::erase_if(effects, [&](const auto& e) { return e.second.deviations >= options.surely_seen; });
  return effects;
}

// The names of re-tuned parameters of these kinds that nobody measured, without their soils'.
std::vector<std::string> names_of(const FittedExplanation& null, const Kinds& kinds) {
  std::vector<std::string> names;
  for (const Parameter& parameter : null.hypothesis.parameters()) {
    if (!parameter.is_told_by_drives() || !parameter.kind || !among(kinds, *parameter.kind)) continue;
    std::string name = parameter.name.substr(0, parameter.name.find('/'));
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
  }
  return names;
}

}  // namespace

std::vector<MeasurementProposal> measurement_proposals(const ExplanationSearch& search,
                                                       const Whitening& whitened,
                                                       const DescriptionOptions& options) {
  std::map<std::string, Unseen> unseen = unseen_effects(search, whitened, options);
  std::vector<MeasurementProposal> proposals;
  for (const Kinds& kinds : measurements()) {
    if (unseen.empty()) break;
    const Eigen::MatrixXd taken = taken_beside(search.fits[0], kinds);
    std::erase_if(unseen, [&](const auto& entry) {
      const double then = most_visible(entry.second, taken);
      if (then < options.surely_seen) return false;
      proposals.push_back(
          {entry.first, kinds, names_of(search.fits[0], kinds), entry.second.deviations, then});
      return true;
    });
  }
  std::stable_sort(
      proposals.begin(), proposals.end(),
      [](const MeasurementProposal& a, const MeasurementProposal& b) { return a.effect < b.effect; });
  return proposals;
}

}  // namespace slipway::gap
