#include "sealed_campaign.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "hidden_causes.h"

namespace slipway::gap_benchmark {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr std::array<double, 3> kSpeeds{0.025, 0.04, 0.05};
constexpr std::array<double, 3> kHillSpeeds{0.03, 0.04, 0.05};
constexpr std::array<double, 4> kTemperatures{-40.0, -20.0, 0.0, 20.0};

template <std::size_t N>
double one_of(const std::array<double, N>& values, RandomStream& random) {
  return values[random.below(N)];
}

std::string drive_name(std::size_t number) {
  std::array<char, 8> text;
  std::snprintf(text.data(), text.size(), "D%03u", static_cast<unsigned>(number + 1));
  return text.data();
}

// 44 drives on a table tilted by 0 to 18 deg: up twice, down, across either way, both arcs, backward twice, a
// turn in place; there are neither arcs nor a turn on the steep tables.
std::vector<DriveOrder> tilt_orders(RandomStream& random) {
  std::vector<DriveOrder> orders;
  for (const int tilt : {0, 5, 10, 15, 18}) {
    std::array<char, 16> terrain;
    std::snprintf(terrain.data(), terrain.size(), "tilt_%02d", tilt);
    const auto add = [&](double yaw_deg, double curvature, bool backward, bool turn) {
      DriveOrder order;
      order.terrain = terrain.data();
      order.speed_m_s = one_of(kSpeeds, random) * (backward ? -1.0 : 1.0);
      order.curvature_1_m = curvature;
      order.turn_in_place = turn;
      order.duration_s = turn ? 40.0 : 60.0;
      order.start_yaw_rad = yaw_deg * kRadPerDeg;
      order.motor_temp_c = one_of(kTemperatures, random);
      orders.push_back(order);
    };
    for (const double yaw : {0.0, 0.0, 180.0, 90.0, -90.0}) add(yaw, 0.0, false, false);
    if (tilt <= 10) {
      add(0.0, 0.4, false, false);
      add(0.0, -0.4, false, false);
    }
    add(0.0, 0.0, true, false);
    add(0.0, 0.0, true, false);
    if (tilt <= 10) add(0.0, 0.0, false, true);
  }
  return orders;
}

DriveOrder hills_order(std::size_t number, RandomStream& random) {
  constexpr std::array<double, 6> kCurvatures{0.0, 0.0, 0.0, 0.0, 0.15, -0.15};
  DriveOrder order;
  order.terrain = "hills";
  order.speed_m_s = one_of(kHillSpeeds, random);
  order.curvature_1_m = number == 15 ? 0.3 : one_of(kCurvatures, random);
  order.duration_s = 150.0;
  order.start_x_m = random.uniform(-10.0, 10.0);
  order.start_y_m = random.uniform(-10.0, 10.0);
  order.start_yaw_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
  order.motor_temp_c = one_of(kTemperatures, random);
  return order;
}

Closure closure_of(Fidelity fidelity, RandomStream& random, TrueSoil& soil) {
  Closure closure;
  if (fidelity == Fidelity::kOtherPhysics)
    closure.pull_below_axle = 0.0;  // forces act at their contact points
  if (fidelity != Fidelity::kOtherClosures) return closure;
  closure.parabolic_stress = random.uniform() < 0.5;
  closure.coupled_shear = random.uniform() < 0.7;
  closure.exit_share = random.uniform(0.05, 0.25);
  closure.rise_share = random.uniform(0.0, 0.08);
  closure.pull_below_axle = random.uniform(0.5, 1.0);
  soil.c1 *= random.uniform(0.8, 1.25);
  soil.c2 *= random.uniform(0.8, 1.25);
  return closure;
}

double spread_of(NominalSoil nominal) {
  switch (nominal) {
    case NominalSoil::kTrue:
      return 0.0;
    case NominalSoil::kNear:
      return 0.15;
    case NominalSoil::kMeasured:
      return 0.3;
    case NominalSoil::kUsual:
      return 1.0;
    case NominalSoil::kFar:
      return 1.6;
  }
  return 1.0;
}

double digits(double value, int count) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.*g", count, value);
  return std::strtod(text.data(), nullptr);
}

// The soil as the operators assume it.
TrueSoil believed(const TrueSoil& soil, double spread, RandomStream& random) {
  TrueSoil nominal = soil;
  nominal.c1 = 0.18;
  nominal.c2 = 0.32;
  if (spread == 0.0) return nominal;
  const auto factor = [&](double deviation) {
    return std::clamp(std::exp(deviation * spread * random.bounded()), 0.75, 1.25);
  };
  nominal.k_c = digits(soil.k_c * factor(0.10), 4);
  nominal.k_phi = digits(soil.k_phi * factor(0.08), 4);
  nominal.n = digits(soil.n * factor(0.025), 3);
  nominal.cohesion_pa = digits(soil.cohesion_pa * factor(0.08), 4);
  nominal.friction_rad = digits(soil.friction_rad / kRadPerDeg * factor(0.022), 4) * kRadPerDeg;
  nominal.shear_modulus_m = digits(soil.shear_modulus_m * factor(0.09), 4);
  return nominal;
}

const TrueSoil& soil_named(const std::string& name) {
  for (const TrueSoil& soil : true_soils())
    if (soil.name == name) return soil;
  return true_soils().front();
}

// Half of the campaigns are on the two soils of the practice campaigns.
const TrueSoil& drawn_soil(RandomStream& random) {
  const std::vector<TrueSoil>& soils = true_soils();
  return random.uniform() < 0.5 ? soils[random.below(2)] : soils[2 + random.below(soils.size() - 2)];
}

// A patch at a place where several drives pass, but not all of them.
void place_patch(const std::vector<MadeDrive>& drives, RandomStream& random, HiddenTruth& hidden) {
  std::size_t most = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const MadeDrive& drive = drives[random.below(drives.size())];
    const DriveRow& row = drive.rows[drive.rows.size() / 4 + random.below(drive.rows.size() / 2)];
    const double x = row.x_m + random.uniform(-1.0, 1.0), y = row.y_m + random.uniform(-1.0, 1.0);
    std::size_t passed = 0;
    for (const MadeDrive& other : drives)
      passed += std::any_of(other.rows.begin(), other.rows.end(), [&](const DriveRow& at) {
        return std::hypot(at.x_m - x, at.y_m - y) < 0.8 * hidden.patch_radius_m;
      });
    if (passed <= most || passed > drives.size() / 2) continue;
    most = passed;
    hidden.patch_x_m = digits(x, 4);
    hidden.patch_y_m = digits(y, 4);
  }
}

// With `since` the drives before it meet nothing hidden.
std::vector<MadeDrive> drive_all(const World& changed, const std::vector<NamedTerrain>& terrains,
                                 const std::vector<DriveOrder>& orders, std::uint64_t seed,
                                 std::size_t since = 0) {
  const World healthy = without_hidden_causes(changed);
  std::vector<MadeDrive> drives;
  for (std::size_t i = 0; i < orders.size(); ++i)
    for (const NamedTerrain& terrain : terrains) {
      const World& world = i < since ? healthy : changed;
      if (terrain.name != orders[i].terrain) continue;
      RandomStream random(seed + i);
      std::vector<DriveRow> rows = simulate_drive(world, terrain.grid, orders[i], random).rows;
      // A drive in which the rover never moved has no rows.
      if (rows.size() >= 2) drives.push_back({orders[i], std::move(rows), seed + i});
    }
  return drives;
}

std::vector<DriveOrder> hills_orders(const World& world, const TerrainGrid& ground, RandomStream& random) {
  std::vector<DriveOrder> orders;
  for (int trial = 0; orders.size() < 16 && trial < 400; ++trial) {
    const DriveOrder order = hills_order(orders.size(), random);
    RandomStream soil(random.seed());
    const SimulatedDrive drive = simulate_drive(world, ground, order, soil);
    if (!drive.complete) continue;
    // Operators would not have driven where the rover hardly moves.
    const double way = std::hypot(drive.rows.back().x_m - drive.rows.front().x_m,
                                  drive.rows.back().y_m - drive.rows.front().y_m);
    if (way < 0.2 * order.speed_m_s * order.duration_s) continue;
    orders.push_back(order);
  }
  return orders;
}

// Names, and hours of the day: the order in which drives were made is not that of their numbers on tilt
// tables.
void number(const CampaignCase& made_of, const World& world, RandomStream& random,
            std::vector<DriveOrder>& orders) {
  std::vector<std::size_t> turn(orders.size());
  for (std::size_t i = 0; i < turn.size(); ++i) turn[i] = i;
  if (!made_of.on_hills)
    for (std::size_t i = turn.size(); i > 1; --i) std::swap(turn[i - 1], turn[random.below(i)]);
  const bool by_number = world.hidden.solar_softening != 0.0 || world.hidden.current_gain_drift != 0.0;
  for (std::size_t i = 0; i < orders.size(); ++i) {
    orders[i].id = drive_name(i);
    orders[i].share_of_day = static_cast<double>(by_number ? i : turn[i]) /
                             std::max<double>(1.0, static_cast<double>(orders.size()) - 1.0);
  }
}

}  // namespace

SealedCampaign make_campaign(const CampaignCase& made_of, RandomStream& random) {
  SealedCampaign made;
  made.made_of = made_of;
  World& world = made.world;
  world.soil = made_of.soil ? soil_named(*made_of.soil) : drawn_soil(random);
  world.closure = closure_of(made_of.fidelity, random, world.soil);
  world.soil_contact_model = made_of.fidelity == Fidelity::kOtherPhysics;
  if (made_of.even_soil) world.scatter = {0.0, 0.0, 0.0, 0.0, 1.5};
  world.hidden.other_equations = made_of.fidelity != Fidelity::kSameEquations;
  made.nominal = believed(made_of.soil ? soil_named(*made_of.soil) : soil_named(world.soil.name),
                          spread_of(made_of.nominal), random);
  for (const std::string& cause : made_of.causes)
    hide(cause, made_of.size, random, world.hidden, made.effects);

  std::vector<DriveOrder> orders;
  if (made_of.on_hills) {
    made.terrains.push_back({"hills", hills(random)});
    World bare = world;
    bare.hidden.patch_weakening = 0.0;
    orders = hills_orders(bare, made.terrains.front().grid, random);
  } else {
    for (const int tilt : {0, 5, 10, 15, 18}) {
      std::array<char, 16> name;
      std::snprintf(name.data(), name.size(), "tilt_%02d", tilt);
      made.terrains.push_back({name.data(), tilted_plane(tilt)});
    }
    orders = tilt_orders(random);
  }
  if (made_of.max_drives > 0 && orders.size() > made_of.max_drives) {
    // Drives are left out at equal intervals, so that all tilts remain.
    std::vector<DriveOrder> kept;
    for (std::size_t i = 0; i < made_of.max_drives; ++i)
      kept.push_back(orders[i * orders.size() / made_of.max_drives]);
    orders = std::move(kept);
  }
  if (made_of.since_drive > 0)
    for (std::size_t i = orders.size(); i > 1; --i) std::swap(orders[i - 1], orders[random.below(i)]);
  number(made_of, world, random, orders);
  const std::uint64_t seed = random.seed();
  if (world.hidden.patch_weakening > 0.0) {
    World bare = world;
    bare.hidden.patch_weakening = 0.0;
    place_patch(drive_all(bare, made.terrains, orders, seed), random, world.hidden);
    made.effects["soft_patch"]["x_m"] = world.hidden.patch_x_m;
    made.effects["soft_patch"]["y_m"] = world.hidden.patch_y_m;
  }
  made.drives = drive_all(world, made.terrains, orders, seed, made_of.since_drive);
  made.noise_seed = random.seed();
  return made;
}

void add_drives(SealedCampaign& campaign, std::vector<DriveOrder> orders, RandomStream& random) {
  for (std::size_t i = 0; i < orders.size(); ++i) {
    orders[i].id = drive_name(campaign.drives.size() + i);
    orders[i].share_of_day = 1.0;
  }
  for (MadeDrive& drive : drive_all(campaign.world, campaign.terrains, orders, random.seed()))
    campaign.drives.push_back(std::move(drive));
}

SealedCampaign healthy_reference(const SealedCampaign& campaign, RandomStream& random) {
  SealedCampaign made;
  made.made_of = campaign.made_of;
  made.made_of.causes.clear();
  made.world = without_hidden_causes(campaign.world);
  made.nominal = campaign.nominal;
  made.terrains = campaign.terrains;
  std::vector<DriveOrder> orders = made.made_of.on_hills
                                       ? hills_orders(made.world, made.terrains.front().grid, random)
                                       : tilt_orders(random);
  number(made.made_of, made.world, random, orders);
  made.drives = drive_all(made.world, made.terrains, orders, random.seed());
  made.noise_seed = random.seed();
  return made;
}

}  // namespace slipway::gap_benchmark
