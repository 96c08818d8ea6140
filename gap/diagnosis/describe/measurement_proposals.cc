#include "gap/diagnosis/describe/measurement_proposals.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "gap/diagnosis/model/nuisance_catalogue.h"

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

// "stiffness/sand" is a copy of the row "stiffness".
NuisanceKind kind_of(const std::string& parameter) {
  const std::string row = parameter.substr(0, parameter.find('/'));
  for (const Nuisance& nuisance : nuisance_catalogue())
    if (nuisance.name == row) return nuisance.kind;
  return NuisanceKind::kClosure;
}

bool among(const Kinds& kinds, NuisanceKind kind) {
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

// Directions that re-tuning takes where parameters of these kinds are known.
Eigen::MatrixXd taken_beside(const FittedExplanation& null, const Kinds& known) {
  std::vector<Eigen::Index> left;
  const auto parameters = null.hypothesis.parameters();
  for (std::size_t p = 0; p < null.hypothesis.nuisance_count(); ++p)
    if (!among(known, kind_of(parameters[p].name))) left.push_back(static_cast<Eigen::Index>(p));
  const Eigen::MatrixXd columns = null.white_jacobian(Eigen::all, left);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::MatrixXd all = qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
  return all.leftCols(qr.rank());
}

double visible(const Eigen::VectorXd& response, const Eigen::MatrixXd& taken) {
  return (response - taken * (taken.transpose() * response)).norm();
}

// An effect that was not surely seen in any of its ways, with the whitened response of each at its usual
// size.
struct Unseen {
  double deviations = 0.0;
  std::vector<Eigen::VectorXd> responses;
};

std::map<std::string, Unseen> unseen_effects(const ExplanationSearch& search, const Whitening& whitened,
                                             const VerdictOptions& options) {
  std::map<std::string, Unseen> effects;
  for (const ScreenedVariant& s : search.screened) {
    Unseen& of = effects[s.variant.effect];
    of.deviations = std::max(of.deviations, s.visibility);
  }
  std::erase_if(effects, [&](const auto& e) { return e.second.deviations >= options.surely_seen; });
  for (const ScreenedVariant& s : search.screened)
    if (const auto of = effects.find(s.variant.effect); of != effects.end() && s.columns.cols() > 0)
      of->second.responses.push_back(whitened(s.columns.col(0)));
  return effects;
}

}  // namespace

std::vector<MeasurementProposal> measurement_proposals(const ExplanationSearch& search,
                                                       const Whitening& whitened,
                                                       const VerdictOptions& options) {
  std::map<std::string, Unseen> unseen = unseen_effects(search, whitened, options);
  std::vector<MeasurementProposal> proposals;
  for (const Kinds& kinds : measurements()) {
    if (unseen.empty()) break;
    const Eigen::MatrixXd taken = taken_beside(search.fits[0], kinds);
    std::erase_if(unseen, [&](const auto& entry) {
      double most = 0.0;
      for (const Eigen::VectorXd& response : entry.second.responses)
        most = std::max(most, visible(response, taken));
      if (most < options.surely_seen) return false;
      proposals.push_back({entry.first, kinds, entry.second.deviations, most});
      return true;
    });
  }
  std::stable_sort(
      proposals.begin(), proposals.end(),
      [](const MeasurementProposal& a, const MeasurementProposal& b) { return a.effect < b.effect; });
  return proposals;
}

}  // namespace slipway::gap
