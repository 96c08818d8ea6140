#include "gap/diagnosis/describe/look_alikes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace slipway::gap {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
// Of an effect's trace: re-tuned parameters that take less than this do not look like it.
constexpr double kMostOfIt = 0.5;

// The first variant of each effect whose signature is there.
std::vector<const ScreenedVariant*> first_of_each(std::span<const ScreenedVariant> screened,
                                                  const DescriptionOptions& options) {
  std::vector<const ScreenedVariant*> first;
  for (const ScreenedVariant& s : screened)
    if (s.signature.size() > 0 && s.signature.norm() > options.min_signature &&
        std::none_of(first.begin(), first.end(),
                     [&](const auto* f) { return f->variant.effect == s.variant.effect; }))
      first.push_back(&s);
  return first;
}

// The least angle from a trace to what `cause` could look like, in any of its variants.
double angle_deg(const Eigen::VectorXd& trace, std::span<const ScreenedVariant> screened,
                 const std::string& cause) {
  double most = 0.0;
  for (const ScreenedVariant& s : screened)
    if (s.variant.effect == cause && s.reach.size() > 0)
      most = std::max(most, (s.reach.transpose() * trace).norm() / trace.norm());
  return kDegPerRad * std::acos(std::min(1.0, most));
}

}  // namespace

std::vector<ConfusablePair> confusable_pairs(const ExplanationSearch& search,
                                             const DescriptionOptions& options) {
  const std::vector<const ScreenedVariant*> first = first_of_each(search.screened, options);
  std::vector<ConfusablePair> pairs;
  for (std::size_t a = 0; a < first.size(); ++a)
    for (std::size_t b = a + 1; b < first.size(); ++b) {
      const std::string &one = first[a]->variant.effect, &other = first[b]->variant.effect;
      const double angle = std::min(angle_deg(first[a]->signature, search.screened, other),
                                    angle_deg(first[b]->signature, search.screened, one));
      if (angle < options.max_angle_deg) pairs.push_back({one, other, angle});
    }
  std::stable_sort(pairs.begin(), pairs.end(), [](const ConfusablePair& a, const ConfusablePair& b) {
    return a.angle_deg < b.angle_deg;
  });
  return pairs;
}

std::vector<LookAlike> look_alikes(const ExplanationSearch& search, const DescriptionOptions& options) {
  std::vector<LookAlike> alike;
  const std::vector<const ScreenedVariant*> effects = first_of_each(search.screened, options);
  const auto compare = [&](const ScreenedVariant& effect, const ScreenedVariant& other,
                           std::span<const ScreenedVariant> among) {
    const double angle = angle_deg(effect.signature, among, other.variant.effect);
    if (angle < options.max_angle_deg)
      alike.push_back({effect.variant.effect, other.variant.effect, {}, angle});
  };
  for (const ScreenedVariant* effect : effects) {
    for (const ScreenedVariant* other : effects)
      if (other != effect) compare(*effect, *other, search.screened);
    for (const ScreenedVariant* outside : first_of_each(search.screened_outside, options))
      compare(*effect, *outside, search.screened_outside);
  }
  std::vector<std::string> seen;  // effects of which one variant would surely have shown
  for (const ScreenedVariant& s : search.screened)
    if (s.visibility >= options.surely_seen) seen.push_back(s.variant.effect);
  for (const ScreenedVariant& s : search.screened) {
    if (std::find(seen.begin(), seen.end(), s.variant.effect) != seen.end() || s.visibility <= 0.0 ||
        s.kept_share > kMostOfIt)
      continue;
    seen.push_back(s.variant.effect);
    LookAlike& own = alike.emplace_back();
    own.effect = s.variant.effect;
    own.like = "parameters";
    own.angle_deg = kDegPerRad * std::asin(std::min(1.0, s.kept_share));
    const auto parameters = search.fits[0].hypothesis.parameters();
    for (const std::size_t p : s.taken_by) own.which.push_back(parameters[p].name);
  }
  std::stable_sort(alike.begin(), alike.end(),
                   [](const LookAlike& a, const LookAlike& b) { return a.angle_deg < b.angle_deg; });
  return alike;
}

}  // namespace slipway::gap
