#include "campaign_case.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include "hidden_causes.h"

namespace slipway::gap_benchmark {
namespace {

using Pair = std::pair<const char*, const char*>;
constexpr std::array kPairs{Pair{"grousers", "wheel_radius"},        Pair{"slip_sinkage", "com_offset"},
                            Pair{"multipass", "gearbox_friction"},   Pair{"motor_temperature", "bulldozing"},
                            Pair{"rate_shear", "steering_offset"},   Pair{"hardpan", "dragging_wheel"},
                            Pair{"side_bulldozing", "slip_sinkage"}, Pair{"soft_patch", "motor_temperature"}};
constexpr std::array kAlike{
    Pair{"bulldozing", "attitude_bias"}, Pair{"gearbox_friction", "motor_temperature"},
    Pair{"multipass", "com_offset"},     Pair{"duricrust", "hardpan"},
    Pair{"grousers", "rate_shear"},      Pair{"wheel_radius", "slip_sinkage"}};

template <class T>
void shuffle(std::vector<T>& items, RandomStream& random) {
  for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[random.below(i)]);
}

bool needs_hills(const std::vector<std::string>& causes) {
  return std::find(causes.begin(), causes.end(), "soft_patch") != causes.end();
}

double drawn_size(RandomStream& random) {
  const double u = random.uniform();
  return u < 0.2 ? 0.5 : u < 0.7 ? 1.0 : 2.0;
}

class CaseList {
 public:
  CaseList(std::optional<Fidelity> fidelity, RandomStream& random) : fidelity_(fidelity), random_(random) {}

  CampaignCase& add(std::vector<std::string> causes, double size) {
    CampaignCase made;
    made.on_hills = needs_hills(causes) || random_.uniform() < 0.34;
    made.causes = std::move(causes);
    made.size = size;
    made.fidelity = fidelity_.value_or(random_.uniform() < 2.0 / 3.0 ? Fidelity::kOtherEffects
                                                                     : Fidelity::kOtherClosures);
    cases_.push_back(std::move(made));
    return cases_.back();
  }
  CampaignCase& add_control(NominalSoil nominal) {
    CampaignCase& made = add({}, 1.0);
    made.nominal = nominal;
    return made;
  }
  std::vector<CampaignCase> take() { return std::move(cases_); }

 private:
  std::optional<Fidelity> fidelity_;
  RandomStream& random_;
  std::vector<CampaignCase> cases_;
};

std::vector<CampaignCase> blind(CaseList list, RandomStream& random) {
  for (const std::string_view effect : library_effects()) list.add({std::string(effect)}, drawn_size(random));
  std::vector<Pair> pairs(kPairs.begin(), kPairs.end());
  shuffle(pairs, random);
  for (std::size_t i = 0; i < 3; ++i) list.add({pairs[i].first, pairs[i].second}, 1.0);
  list.add_control(NominalSoil::kTrue);
  list.add_control(NominalSoil::kNear);
  list.add_control(NominalSoil::kUsual);
  list.add_control(NominalSoil::kFar);
  std::vector<std::string> foreign(foreign_causes().begin(), foreign_causes().end());
  shuffle(foreign, random);
  for (std::size_t i = 0; i < 3; ++i) list.add({foreign[i]}, random.uniform() < 0.6 ? 1.0 : 2.0);
  return list.take();
}

std::vector<CampaignCase> full(CaseList list) {
  for (const std::string_view effect : library_effects())
    for (const double size : {0.5, 1.0, 2.0}) list.add({std::string(effect)}, size);
  for (const Pair& pair : kPairs) list.add({pair.first, pair.second}, 1.0);
  for (const Pair& pair : kAlike) list.add({pair.first, pair.second}, 1.0);
  for (const NominalSoil nominal :
       {NominalSoil::kTrue, NominalSoil::kNear, NominalSoil::kUsual, NominalSoil::kFar})
    for (int i = 0; i < 4; ++i) list.add_control(nominal).on_hills = i == 3;
  for (const std::string_view cause : foreign_causes())
    for (const double size : {1.0, 2.0}) list.add({std::string(cause)}, size);
  for (const char* effect : {"slip_sinkage", "hardpan", "multipass"}) list.add({effect}, 1.0).sinkage = false;
  for (const char* effect : {"motor_temperature", "gearbox_friction"})
    list.add({effect}, 1.0).temperature = false;
  for (const char* effect : {"com_offset", "bulldozing", "wheel_radius"})
    list.add({effect}, 1.0).max_drives = 6;
  return list.take();
}

std::vector<CampaignCase> each(CaseList list) {
  for (const std::string_view effect : library_effects()) list.add({std::string(effect)}, 1.0);
  for (const std::string_view cause : foreign_causes()) list.add({std::string(cause)}, 1.0);
  return list.take();
}

std::vector<CampaignCase> smoke(CaseList list) {
  for (const bool something : {false, true}) {
    CampaignCase& made =
        something ? list.add({"gearbox_friction"}, 2.0) : list.add_control(NominalSoil::kTrue);
    made.on_hills = false;
    made.max_drives = 9;
    made.soil = "sandy-loam";
    made.fidelity = Fidelity::kOtherEffects;
  }
  return list.take();
}

std::vector<CampaignCase> nothing(CaseList list) {
  CampaignCase& made = list.add_control(NominalSoil::kTrue);
  made.on_hills = false;
  made.soil = "sandy-loam";
  made.fidelity = Fidelity::kOtherEffects;
  return list.take();
}

std::vector<CampaignCase> other_physics(CaseList list) {
  const auto add = [&](std::vector<std::string> causes, bool on_hills) -> CampaignCase& {
    CampaignCase& made = list.add(std::move(causes), 1.0);
    made.on_hills = on_hills;
    made.fidelity = Fidelity::kOtherPhysics;
    return made;
  };
  add({}, false).soil = "sandy-loam";
  add({}, false).soil = "fine-sand";
  add({}, true);
  for (const char* cause :
       {"motor_temperature", "com_offset", "gearbox_friction", "wheel_radius", "dragging_wheel", "tether"})
    add({cause}, false);
  add({"soft_patch"}, true);
  return list.take();
}

// Forces of the world and sensors that read wrongly, each alone, and four beside an effect of the library.
std::vector<CampaignCase> outside(CaseList list) {
  for (const char* cause : {"tether", "side_wind", "odometry_yaw_scale", "current_gain_drift"})
    list.add({cause}, 1.0);
  for (const std::string_view cause : world_causes()) list.add({std::string(cause)}, 1.0);
  for (const auto& [effect, cause] :
       {Pair{"motor_temperature", "tether"}, Pair{"wheel_radius", "side_wind"},
        Pair{"slip_sinkage", "current_gain_drift"}, Pair{"gearbox_friction", "wheel_snag"}})
    list.add({effect, cause}, 1.0);
  return list.take();
}

}  // namespace

std::string name_of(Fidelity fidelity) {
  switch (fidelity) {
    case Fidelity::kSameEquations:
      return "L1";
    case Fidelity::kOtherEffects:
      return "L2";
    case Fidelity::kOtherClosures:
      return "L2c";
    case Fidelity::kOtherPhysics:
      return "L3";
  }
  return "";
}

std::optional<std::vector<CampaignCase>> cases_of(const std::string& set, std::optional<Fidelity> fidelity,
                                                  RandomStream& random) {
  CaseList list(fidelity, random);
  std::optional<std::vector<CampaignCase>> cases;
  if (set == "blind") cases = blind(list, random);
  if (set == "full") cases = full(list);
  if (set == "each") cases = each(list);
  if (set == "smoke") cases = smoke(list);
  if (set == "nothing") cases = nothing(list);
  if (set == "other_physics") cases = other_physics(list);
  if (set == "outside") cases = outside(list);
  if (cases) {
    for (CampaignCase& made_of : *cases) made_of.seed = random.seed();
    shuffle(*cases, random);
  }
  return cases;
}

std::optional<std::string> impossible_cause(const CampaignCase& made_of) {
  if (made_of.fidelity == Fidelity::kOtherPhysics)
    for (const std::string& cause : made_of.causes)
      if (is_of_arc_law(cause)) return cause;
  return std::nullopt;
}

const std::vector<TrueSoil>& true_soils() {
  constexpr double kDeg = std::numbers::pi / 180.0;
  static const std::vector<TrueSoil> soils{
      {"sandy-loam", 20000.0, 1.2e6, 0.95, 1500.0, 36.0 * kDeg, 0.0100, 1500.0},
      {"fine-sand", 6940.0, 905800.0, 0.85, 960.0, 33.0 * kDeg, 0.0114, 1450.0},
      {"medium-simulant", 10843.0, 1638496.0, 0.993, 672.0, 37.1 * kDeg, 0.0171, 1500.0},
      {"drift", 5000.0, 700000.0, 0.90, 800.0, 34.0 * kDeg, 0.0130, 1400.0},
      {"cloddy-loam", 30000.0, 2.2e6, 1.02, 2200.0, 33.0 * kDeg, 0.0150, 1550.0},
      {"coarse-sand", 12000.0, 1.0e6, 0.90, 1000.0, 35.0 * kDeg, 0.0140, 1500.0}};
  return soils;
}

}  // namespace slipway::gap_benchmark
