#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_set>
#include <vector>

#include "sim/prediction/drive_prediction.h"

namespace slipway::sim {

// The size of a unit of ground over which one soil holds: of the units that are mapped at Marias Pass most
// are 50 to 200 m wide.
inline constexpr double kUnitLength_m = 100.0;

// The share of units in which the rover can't drive even on the level: one in some 1,000 units of 100 m.
inline constexpr double kWeakShare = 0.001;

// A rover drives level ground where it slips less than this on it.
inline constexpr double kMaxLevelSlip = 0.2;

// The strength of one soil with the pressure of another, at the same normal numbers. A soil that is known by
// its slip curve alone has neither: then it is the first as it is.
Soil joined_soil(const SoilDistribution& strength, const SoilDistribution& pressure, const SoilNormals& z,
                 const ClosureNormals& closures = ClosureNormals::Zero());

// The one of the alternatives, by their weights, that a uniform number falls on; of those that lie in patches
// within units or of the others alone, where `in_patches` says which.
const SoilDistribution& chosen_alternative(const std::vector<SoilAlternative>& alternatives,
                                           double SoilAlternative::*weight, double uniform,
                                           const std::vector<double>& commonness = {},
                                           std::optional<bool> in_patches = {});

// A belief's own normal numbers, pushed to where few units and patches are weaker: an alternative must carry
// the rover on level ground even there.
SoilNormals weak_unit(const SoilDistribution& belief, const SoilNormals& everywhere);

// One draw of all the ground, for a workspace of one thread: which soil lies at each place. It is a function
// of the key and the place alone, so that routes under one key meet the same ground wherever they cross,
// however their stations are spaced, and a drive of the past tells of the ground of the next.
//
// The normal numbers of a soil are the sum of one for all ground of that soil, one that changes over
// kUnitLength_m and one that changes over the soil's correlation length, weighted by the shares of the
// variance. Those that change are normal numbers at the corners of a lattice, blended between them with a
// variance of one everywhere. Of alternatives one is chosen for all ground of the soil, or one for each unit:
// the cell of the nearest of the jittered centres of a lattice. Alternatives in patches lie over the units:
// each cell of a lattice with the soil's correlation length is such a patch with the probability of their
// share of the weights.
//
// Alternatives that are drawn apart and on which the rover would slip by 20 % or more on level ground are
// drawn again, but for a share of kWeakShare: their numbers come from tests of a few wheels and trenches,
// while rovers have driven such ground for some 100 km and were embedded with their slip checked every few
// metres once (Spirit at Troy).
class DrawnGround {
 public:
  // Whether the rover drives level ground of a soil; where it is empty, all soils are drawn as they come.
  using DrivesLevel = std::function<bool(const Soil&)>;

  // `redrawn` are the cells that what was driven has made another draw of; it must outlive this.
  DrawnGround(const SoilBeliefs& beliefs, std::uint64_t key, DrivesLevel drives_level = {},
              const RedrawnCells* redrawn = nullptr);

  // The soil at a place of ground that is believed to be soil `soil`, or unknown ground where it is empty.
  // The reference holds until the next call.
  const Soil& at(std::optional<std::size_t> soil, double x_m, double y_m);
  // The ratio of ln(1 - slip), on the real ground over the model's, at the place of the last call for that
  // soil.
  double slip_scale(std::optional<std::size_t> soil) const;

  // Notes the units and patches that are met from now on; `met` must outlive this.
  void note(std::unordered_set<std::uint64_t>& met) { met_ = &met; }

 private:
  // Those of a soil, one for the error of slip, and those of c1 and c2 where these have a spread.
  using Normals = Eigen::Matrix<double, kSoilDims + 1 + kClosureDims, 1>;
  // Normal numbers at the corners of one cell of a lattice.
  struct Corners {
    bool filled = false;
    bool with_closures = false;
    long long column = 0, row = 0;
    std::array<Normals, 4> normals;
  };
  struct Belief {
    const SoilDistribution* distribution = nullptr;
    std::uint64_t key = 0;
    bool with_closures = false;  // c1 or c2 has a spread
    Normals everywhere;
    std::vector<double> commonness;  // factor of each alternative's weight in this draw
    double share_in_patches = 0.0;   // of alternatives by unit, in this draw
    bool in_patch = false;           // the place lies in such a patch
    Corners unit, patch;
    // The alternatives that were chosen for one unit, or for all ground.
    std::optional<std::uint64_t> chosen_for;
    const SoilDistribution* strength = nullptr;
    const SoilDistribution* pressure = nullptr;
    Soil soil;
    double slip_scale = 1.0;
    double x_m = 0.0, y_m = 0.0;  // where `soil` was drawn
    bool drawn = false;
  };

  static Normals normals_of(std::uint64_t key, bool with_closures);
  // The key of a unit or patch of this draw.
  std::uint64_t redrawn(std::uint64_t cell);
  std::uint64_t cell_at(std::uint64_t key, double length_m, double x_m, double y_m);
  Normals blended(Corners& corners, std::uint64_t key, double length_m, double x_m, double y_m);
  Soil draw(Belief& belief, double x_m, double y_m);
  static double share_in_patches(const Belief& belief);
  std::uint64_t unit_or_patch(Belief& belief, double x_m, double y_m);
  void choose(Belief& belief, std::uint64_t cell) const;

  const SoilBeliefs& beliefs_;
  std::uint64_t key_;
  DrivesLevel drives_level_;
  const RedrawnCells* redrawn_;
  std::unordered_set<std::uint64_t>* met_ = nullptr;
  std::vector<std::optional<Belief>> drawn_;  // by soil; the last is unknown ground
};

}  // namespace slipway::sim
