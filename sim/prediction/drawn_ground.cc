#include "sim/prediction/drawn_ground.h"

#include <algorithm>
#include <cmath>

#include "core/digest.h"
#include "core/random.h"

namespace slipway::sim {
namespace {

// Streams of one belief's random numbers.
enum Stream : std::uint64_t {
  kEverywhere,
  kUnit,
  kPatch,
  kPressureChoice,
  kStrengthChoice,
  kJitter,
  kWeak,
  kCommonness,
  kInPatches,
  kPatchOrUnit,
  kShareOfUnit
};

// Cells are redrawn by the numbers of tries below this, and renewed by those above.
constexpr std::uint64_t kMostTries = 1ULL << 32U;

std::uint64_t cell_key(std::uint64_t key, long long column, long long row) {
  return random_key(random_key(key, static_cast<std::uint64_t>(column)), static_cast<std::uint64_t>(row));
}

// By the soil's name: the index of a soil in a map's legend is another for another window of the map.
std::uint64_t name_key(std::uint64_t key, const std::string& name) {
  return random_key(key, fnv1a(name));
}

bool has_closure_spread(const SoilDistribution& of) {
  bool has = of.std.c1 > 0.0 || of.std.c2 > 0.0;
  for (const SoilAlternative& each : of.alternatives) has = has || has_closure_spread(*each.soil);
  return has;
}

}  // namespace

const SoilDistribution& chosen_alternative(const std::vector<SoilAlternative>& alternatives,
                                           double SoilAlternative::*weight, double uniform,
                                           const std::vector<double>& commonness,
                                           std::optional<bool> in_patches) {
  const auto weight_of = [&](std::size_t k) {
    if (in_patches && alternatives[k].in_patches != *in_patches) return 0.0;
    return alternatives[k].*weight * (commonness.empty() ? 1.0 : commonness[k]);
  };
  double sum = 0.0;
  for (std::size_t k = 0; k < alternatives.size(); ++k) sum += weight_of(k);
  double left = uniform * sum;
  for (std::size_t k = 0; k < alternatives.size(); ++k) {
    left -= weight_of(k);
    if (left < 0.0) return *alternatives[k].soil;
  }
  std::size_t last = alternatives.size() - 1;
  while (last > 0 && weight_of(last) <= 0.0) --last;
  return *alternatives[last].soil;
}

std::uint64_t RedrawnCells::key_of(std::uint64_t cell) const {
  const auto found = keys.find(cell);
  if (found != keys.end()) return found->second;
  return renewal == 0 ? cell : random_key(cell, kMostTries + renewal);
}

Soil joined_soil(const SoilDistribution& strength, const SoilDistribution& pressure, const SoilNormals& z,
                 const ClosureNormals& closures) {
  Soil soil = draw_soil(strength, z, closures);
  if (&pressure == &strength || strength.mean.slip_curve || pressure.mean.slip_curve) return soil;
  const Soil other = draw_soil(pressure, z);
  soil.pressure = other.pressure;
  soil.pressure_law = other.pressure_law;
  return soil;
}

SoilNormals weak_unit(const SoilDistribution& belief, const SoilNormals& everywhere) {
  // Units and patches differ from what all ground of the soil shares: most are not weaker than this.
  constexpr double kDeviations = 1.5;
  return std::sqrt(belief.shares.everywhere) * everywhere +
         kDeviations * std::sqrt(belief.shares.unit + belief.shares.patch) * towards_weakness();
}

DrawnGround::DrawnGround(const SoilBeliefs& beliefs, std::uint64_t key, DrivesLevel drives_level,
                         const RedrawnCells* redrawn)
    : beliefs_(beliefs),
      key_(key),
      drives_level_(std::move(drives_level)),
      redrawn_(redrawn),
      drawn_(beliefs.known.size() + 1) {}

DrawnGround::Normals DrawnGround::normals_of(std::uint64_t key, bool with_closures) {
  Normals z = Normals::Zero();
  const int count = kSoilDims + 1 + (with_closures ? kClosureDims : 0);
  for (int k = 0; k < count; ++k) z[k] = random_normal(key, static_cast<std::uint64_t>(k));
  return z;
}

double DrawnGround::slip_scale(std::optional<std::size_t> soil) const {
  const std::optional<Belief>& belief = drawn_[soil.value_or(beliefs_.known.size())];
  return belief ? belief->slip_scale : 1.0;
}

const Soil& DrawnGround::at(std::optional<std::size_t> soil, double x_m, double y_m) {
  std::optional<Belief>& place = drawn_[soil.value_or(beliefs_.known.size())];
  if (!place) {
    place.emplace();
    place->distribution = &beliefs_.of(soil);
    place->key = name_key(key_, place->distribution->name);
    place->with_closures = has_closure_spread(*place->distribution);
    place->unit.with_closures = place->patch.with_closures = place->with_closures;
    place->everywhere = normals_of(random_key(place->key, kEverywhere), place->with_closures);
    const std::uint64_t commonness = random_key(place->key, kCommonness);
    for (std::size_t k = 0; k < place->distribution->alternatives.size(); ++k)
      place->commonness.push_back(
          std::exp(place->distribution->alternatives_spread * random_normal(commonness, k)));
    if (place->distribution->alternatives_by == AlternativesBy::kUnit)
      place->share_in_patches = share_in_patches(*place);
  }
  Belief& belief = *place;
  // The wheels of a rover at one place are asked for one after another with the place of the rover.
  if (!belief.drawn || belief.x_m != x_m || belief.y_m != y_m) {
    belief.soil = draw(belief, x_m, y_m);
    belief.x_m = x_m;
    belief.y_m = y_m;
    belief.drawn = true;
  }
  return belief.soil;
}

std::uint64_t DrawnGround::redrawn(std::uint64_t cell) {
  if (met_) met_->insert(cell);
  return redrawn_ ? redrawn_->key_of(cell) : cell;
}

// The cell of the lattice whose jittered centre is nearest.
std::uint64_t DrawnGround::cell_at(std::uint64_t key, double length_m, double x_m, double y_m) {
  const auto column = static_cast<long long>(std::floor(x_m / length_m));
  const auto row = static_cast<long long>(std::floor(y_m / length_m));
  double nearest = 1e300;
  std::uint64_t best = 0;
  for (long long r = row - 1; r <= row + 1; ++r) {
    for (long long c = column - 1; c <= column + 1; ++c) {
      const std::uint64_t cell = cell_key(key, c, r);
      const double dx = (static_cast<double>(c) + random_uniform(cell, 0)) * length_m - x_m;
      const double dy = (static_cast<double>(r) + random_uniform(cell, 1)) * length_m - y_m;
      if (dx * dx + dy * dy >= nearest) continue;
      nearest = dx * dx + dy * dy;
      best = cell;
    }
  }
  return redrawn(best);
}

DrawnGround::Normals DrawnGround::blended(Corners& corners, std::uint64_t key, double length_m, double x_m,
                                          double y_m) {
  const double u = x_m / length_m, v = y_m / length_m;
  const auto column = static_cast<long long>(std::floor(u));
  const auto row = static_cast<long long>(std::floor(v));
  if (!corners.filled || corners.column != column || corners.row != row) {
    for (int k = 0; k < 4; ++k)
      corners.normals[static_cast<std::size_t>(k)] =
          normals_of(redrawn(cell_key(key, column + k % 2, row + k / 2)), corners.with_closures);
    corners.filled = true;
    corners.column = column;
    corners.row = row;
  }
  const double a = u - static_cast<double>(column), b = v - static_cast<double>(row);
  const std::array<double, 4> weights{(1.0 - a) * (1.0 - b), a * (1.0 - b), (1.0 - a) * b, a * b};
  Normals sum = Normals::Zero();
  double variance = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    sum += weights[k] * corners.normals[k];
    variance += weights[k] * weights[k];
  }
  return sum / std::sqrt(variance);
}

// The share of the ground that lies in patches within units, in this draw.
double DrawnGround::share_in_patches(const Belief& belief) {
  const std::vector<SoilAlternative>& alternatives = belief.distribution->alternatives;
  double in_patches = 0.0, all = 0.0;
  for (std::size_t k = 0; k < alternatives.size(); ++k) {
    const double weight = alternatives[k].strength_weight * belief.commonness[k];
    all += weight;
    if (alternatives[k].in_patches) in_patches += weight;
  }
  return in_patches / all;
}

// The patch of a soil that lies within units, or the unit. Whether a patch is one of them is drawn for its
// cell, with the share that its unit has.
std::uint64_t DrawnGround::unit_or_patch(Belief& belief, double x_m, double y_m) {
  constexpr double kMostInPatches = 0.9;
  const std::uint64_t unit = cell_at(random_key(belief.key, kJitter), kUnitLength_m, x_m, y_m);
  belief.in_patch = false;
  if (belief.share_in_patches <= 0.0) return unit;
  const double spread = belief.distribution->patches_spread;
  const double share =
      belief.share_in_patches * std::exp(spread * random_normal(unit, kShareOfUnit) - 0.5 * spread * spread);
  const std::uint64_t patch =
      cell_at(random_key(belief.key, kInPatches), belief.distribution->correlation_length_m, x_m, y_m);
  belief.in_patch = random_uniform(patch, kPatchOrUnit) < std::min(share, kMostInPatches);
  return belief.in_patch ? patch : unit;
}

// The rows of pressure and strength of a cell, drawn anew until the rover drives level ground of them.
void DrawnGround::choose(Belief& belief, std::uint64_t cell) const {
  constexpr std::uint64_t kMaxTries = 50;
  const SoilDistribution& of = *belief.distribution;
  const SoilNormals weak = weak_unit(of, belief.everywhere.head<kSoilDims>());
  for (std::uint64_t tried = 0; tried < kMaxTries; ++tried) {
    const std::uint64_t choice = random_key(cell, tried);
    belief.strength = &chosen_alternative(
        of.alternatives, &SoilAlternative::strength_weight, random_uniform(choice, kStrengthChoice),
        belief.commonness, belief.share_in_patches > 0.0 ? std::optional(belief.in_patch) : std::nullopt);
    belief.pressure = belief.strength;
    if (of.drawn_apart)
      belief.pressure = &chosen_alternative(of.alternatives, &SoilAlternative::pressure_weight,
                                            random_uniform(choice, kPressureChoice), belief.commonness);
    if (!of.drawn_apart || !drives_level_ ||
        drives_level_(joined_soil(*belief.strength, *belief.pressure, weak)) ||
        random_uniform(choice, kWeak) < kWeakShare)
      return;
  }
}

Soil DrawnGround::draw(Belief& belief, double x_m, double y_m) {
  const SoilDistribution& of = *belief.distribution;
  const std::uint64_t key = belief.key;
  const Normals patch = std::sqrt(of.shares.patch) *
                        blended(belief.patch, random_key(key, kPatch), of.correlation_length_m, x_m, y_m);
  const Normals unit =
      std::sqrt(of.shares.everywhere) * belief.everywhere +
      std::sqrt(of.shares.unit) * blended(belief.unit, random_key(key, kUnit), kUnitLength_m, x_m, y_m);
  const Normals all = unit + patch;
  belief.slip_scale = std::exp(of.slip_error * all[kSoilDims]);
  const SoilNormals normals = all.head<kSoilDims>();
  const ClosureNormals closures = all.tail<kClosureDims>();
  if (of.alternatives.empty()) return draw_soil(of, normals, closures);
  std::uint64_t choice = key;
  if (of.alternatives_by == AlternativesBy::kUnit)
    choice = unit_or_patch(belief, x_m, y_m);
  else if (of.alternatives_by == AlternativesBy::kPatch)
    choice = cell_at(random_key(key, kJitter), of.correlation_length_m, x_m, y_m);
  if (belief.chosen_for != choice) {
    choose(belief, choice);
    belief.chosen_for = choice;
  }
  return joined_soil(*belief.strength, *belief.pressure, normals, closures);
}

}  // namespace slipway::sim
