#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hidden_truth.h"
#include "random_stream.h"

namespace slipway::gap_benchmark {

enum class Fidelity {
  kSameEquations,  // L1: the library's laws and effects in other code and numerics
  kOtherEffects,   // L2: every effect by another equation, the practice campaigns' wheel law and suspension
  kOtherClosures,  // L2c: that and another stress shape, arc of contact, lateral law and suspension
  kOtherPhysics,   // L3: no arc of stresses; soil of nodes that yield, spring back and are run over again
};
std::string name_of(Fidelity fidelity);

// How far the soil that operators assume is off; of a measured one, by what plate and shear tests leave open.
enum class NominalSoil { kTrue, kNear, kMeasured, kUsual, kFar };

// One campaign to be made.
struct CampaignCase {
  bool on_hills = false;
  std::vector<std::string> causes;
  double size = 1.0;
  NominalSoil nominal = NominalSoil::kUsual;
  bool measured_closures = false;  // campaign.json says that tests of a single wheel told them
  Fidelity fidelity = Fidelity::kOtherEffects;
  std::optional<std::string> soil;  // drawn where it is empty
  std::size_t max_drives = 0;       // 0 for all drives
  bool sinkage = true, temperature = true;
  std::uint64_t seed = 0;  // of everything drawn in it
  // Above 0: so many drives are healthy before the cause sets in, and drives are in an order that is drawn.
  std::size_t since_drive = 0;
  bool even_soil = false;  // no scatter and no sensor noise, for comparisons
};

// The cases of a set: "blind" (26, as an independent judge might choose them), "full" (every effect at three
// sizes and much more), "each" (every cause once), "smoke" (two small ones), "nothing" (p01 again),
// "other_physics" (ten, always of L3), "outside" (14: causes from outside alone, and beside an effect).
std::optional<std::vector<CampaignCase>> cases_of(const std::string& set, std::optional<Fidelity> fidelity,
                                                  RandomStream& random);

// The name of the first cause that the fidelity's wheel law cannot have; empty where there is none.
std::optional<std::string> impossible_cause(const CampaignCase& made_of);

const std::vector<TrueSoil>& true_soils();

}  // namespace slipway::gap_benchmark
