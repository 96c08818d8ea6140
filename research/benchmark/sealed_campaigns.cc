#include "research/benchmark/sealed_campaigns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "core/angle.h"
#include "core/digest.h"
#include "core/random.h"
#include "dem/synthetic_terrain.h"
#include "research/benchmark/hidden_effect.h"
#include "sim/effects/com_offset.h"
#include "sim/effects/gearbox_friction.h"
#include "sim/effects/grousers.h"
#include "sim/effects/multipass.h"
#include "sim/effects/slip_sinkage.h"
#include "sim/effects/wheel_radius.h"

namespace slipway::campaign {
namespace {

constexpr std::array<std::string_view, 3> kSets{"smoke", "each", "each_heavy_wheels"};
constexpr std::string_view kSoil = "nominal", kSoftSoil = "soft";
constexpr std::array kSpeeds{0.025, 0.04, 0.05};
constexpr std::array kTemperatures{-40.0, -20.0, 0.0, 20.0};
constexpr double kTiltDrive_s = 60.0, kTurn_s = 40.0, kRoughDrive_s = 150.0;

// Wheels and linkage, as the quasi-static fidelity level has them by default: the whole weight acts at the
// centre of mass.
const sim::MassDistribution kNearlyWeightless{.wheel_kg = 0.3, .rocker_kg = 0.3, .bogie_kg = 0.2};

class Dice {
 public:
  explicit Dice(std::uint64_t key) : key_(key) {}
  std::uint64_t bits() { return random_bits(key_, next_++); }
  std::size_t below(std::size_t count) { return bits() % count; }
  double uniform() { return random_uniform(key_, next_++); }
  double between(double lowest, double highest) { return lowest + (highest - lowest) * uniform(); }
  double normal() { return random_normal(key_, next_++); }
  template <class List>
  auto one_of(const List& list) {
    return list[below(list.size())];
  }
  template <class T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
  }

 private:
  std::uint64_t key_;
  std::uint64_t next_ = 0;
};

struct TrueSoil {
  std::string_view name;
  double k_c, k_phi, n, cohesion_pa, friction_deg, shear_modulus_m, density_kg_m3;
};
// The first two are those of data/gap-practice.
constexpr std::array kSoils{TrueSoil{"sandy-loam", 20000.0, 1.2e6, 0.95, 1500.0, 36.0, 0.0100, 1500.0},
                            TrueSoil{"fine-sand", 6940.0, 905800.0, 0.85, 960.0, 33.0, 0.0114, 1450.0},
                            TrueSoil{"drift", 5000.0, 700000.0, 0.90, 800.0, 34.0, 0.0130, 1400.0},
                            TrueSoil{"cloddy-loam", 30000.0, 2.2e6, 1.02, 2200.0, 33.0, 0.0150, 1550.0},
                            TrueSoil{"coarse-sand", 12000.0, 1.0e6, 0.90, 1000.0, 35.0, 0.0140, 1500.0}};

sim::Soil soil_of(const TrueSoil& row) {
  sim::Soil soil;
  soil.pressure = {row.k_c, row.k_phi, row.n};
  soil.cohesion_pa = row.cohesion_pa;
  soil.friction_angle_rad = rad_from_deg(row.friction_deg);
  soil.shear_modulus_x_m = soil.shear_modulus_y_m = row.shear_modulus_m;
  soil.density_kg_m3 = row.density_kg_m3;
  soil.c1 = 0.18;
  soil.c2 = 0.32;
  return soil;
}

// What a campaign is to be, before anything is drawn.
struct Order {
  std::vector<std::string_view> effects;
  double size = 1.0;
  std::string_view nominal = "usual";
  bool rough = false, small = false;
  bool sinkage = true, temperature = true;
  bool heavy_wheels = false;
};

double spread_of(std::string_view nominal) {
  if (nominal == "true") return 0.0;
  if (nominal == "near") return 0.15;
  return nominal == "far" ? 1.6 : 1.0;
}

double rounded(double value) {
  return std::strtod(fmt::format("{:.4g}", value).c_str(), nullptr);
}

sim::Soil believed_soil(sim::Soil soil, double spread, Dice& dice) {
  if (spread == 0.0) return soil;
  const auto off = [&](double& value, double deviation) {
    const double factor = std::clamp(std::exp(deviation * spread * dice.normal()), 0.75, 1.25);
    value = rounded(value * factor);
  };
  off(soil.pressure.k_c, 0.10);
  off(soil.pressure.k_phi, 0.08);
  off(soil.pressure.n, 0.025);
  off(soil.cohesion_pa, 0.08);
  double friction_deg = deg_from_rad(soil.friction_angle_rad);
  off(friction_deg, 0.022);
  soil.friction_angle_rad = rad_from_deg(friction_deg);
  off(soil.shear_modulus_x_m, 0.09);
  soil.shear_modulus_y_m = soil.shear_modulus_x_m;
  return soil;
}

// Drives differ by their soil.
sim::SoilDistribution distribution(std::string_view name, const sim::Soil& mean) {
  sim::SoilDistribution soil;
  soil.name = name;
  soil.mean = mean;
  soil.std.stiffness_ratio = 0.055;
  soil.std.friction_angle_rad = 0.01 * mean.friction_angle_rad;
  soil.std.shear_modulus_ratio = 0.06;
  return soil;
}

sim::DriveLeg way(double speed_m_s, double duration_s, double curvature_1_m) {
  sim::DriveLeg leg;
  leg.command.speed_m_s = speed_m_s;
  leg.command.curvature_1_m = curvature_1_m;
  leg.length_m = std::abs(speed_m_s) * duration_s;
  return leg;
}

sim::DriveLeg turn(double rate_rad_s) {
  sim::DriveLeg leg;
  leg.command.turn_in_place = true;
  leg.command.turn_rate_rad_s = rate_rad_s;
  leg.turn_rad = std::abs(rate_rad_s) * kTurn_s;
  return leg;
}

// Up and backward twice, down, across either way; where it is not steep both arcs and a turn on the spot.
void add_tilted_table(DriveTable& table, int tilt_deg, bool small, Dice& dice) {
  const std::size_t terrain = table.terrains.size();
  const std::string name = fmt::format("tilt_{:02}", tilt_deg);
  dem::Relief relief;
  relief.slope_rad = rad_from_deg(tilt_deg);
  table.terrains.push_back(
      {name, dem::make_relief({.size_m = 10.0, .cell_m = 0.25}, relief), "", std::string(kSoil), nullptr});
  const auto add = [&](std::string_view id, double heading_deg, double curvature_1_m, int repeats) {
    DriveEntry& entry = table.entries.emplace_back();
    const double speed_m_s = dice.one_of(kSpeeds);
    entry.id = fmt::format("{}-{}", name, id);
    entry.terrains = {terrain};
    entry.headings_rad = {rad_from_deg(heading_deg)};
    entry.legs = {way(id == "back" ? -speed_m_s : speed_m_s, kTiltDrive_s, curvature_1_m)};
    entry.repeats = repeats;
    entry.motor_temp_c = dice.one_of(kTemperatures);
    return &entry;
  };
  add("up", 0.0, 0.0, 2);
  add("down", 180.0, 0.0, 1);
  add("left", 90.0, 0.0, 1);
  if (!small) add("right", -90.0, 0.0, 1);
  if (!small) add("back", 0.0, 0.0, 2);
  if (small || tilt_deg > 10) return;
  add("arc_left", 0.0, 0.4, 1);
  add("arc_right", 0.0, -0.4, 1);
  add("turn", 0.0, 0.0, 1)->legs = {turn(table.rover->turn_rate_rad_s)};
}

void add_rough_field(DriveTable& table, Dice& dice) {
  constexpr std::array kCurvatures{0.0, 0.0, 0.0, 0.0, 0.15, -0.15};
  constexpr double kMax_m = 9.0;
  dem::Relief relief;
  relief.roughness = {.rms_m = 0.35, .lattice_m = 6.0, .seed = dice.bits()};
  table.terrains.push_back(
      {"field", dem::make_relief({.size_m = 40.0, .cell_m = 0.25}, relief), "", std::string(kSoil), nullptr});
  for (int i = 1; i <= 16; ++i) {
    DriveEntry& entry = table.entries.emplace_back();
    entry.id = fmt::format("drive_{:02}", i);
    entry.terrains = {0};
    entry.x_m = rounded(dice.between(-kMax_m, kMax_m));
    entry.y_m = rounded(dice.between(-kMax_m, kMax_m));
    entry.headings_rad = {dice.between(-std::numbers::pi, std::numbers::pi)};
    entry.legs = {way(dice.one_of(kSpeeds), kRoughDrive_s, dice.one_of(kCurvatures))};
    entry.motor_temp_c = dice.one_of(kTemperatures);
  }
}

// Where the drives are commanded to be, at every tenth of their ways.
std::vector<std::vector<Pose2>> commanded_ways(const DriveTable& table) {
  std::vector<std::vector<Pose2>> ways;
  for (const TableDrive& drive : expand(table)) {
    std::vector<Pose2>& along = ways.emplace_back();
    for (int k = 0; k <= 10; ++k)
      along.push_back(sim::commanded_pose(table.entries[drive.entry].legs[0], drive.start, 0.1 * k));
  }
  return ways;
}

// Where many drives pass, but at most half of them: the others tell the place from the rest.
sim::Disc place_of_patch(const DriveTable& table, double radius_m, Dice& dice) {
  const std::vector<std::vector<Pose2>> ways = commanded_ways(table);
  sim::Disc best{0.0, 0.0, radius_m};
  std::size_t most = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const Pose2 at = dice.one_of(ways)[3 + dice.below(5)];
    const sim::Disc disc{rounded(at.x_m + dice.between(-1.0, 1.0)), rounded(at.y_m + dice.between(-1.0, 1.0)),
                         radius_m};
    const auto passed = static_cast<std::size_t>(std::count_if(ways.begin(), ways.end(), [&](const auto& w) {
      return std::any_of(w.begin(), w.end(), [&](const Pose2& p) { return disc.holds(p.x_m, p.y_m); });
    }));
    if (passed <= most || passed > ways.size() / 2) continue;
    most = passed;
    best = disc;
  }
  return best;
}

// An effect with a region is hidden as a soil of its own in one place of the driven ground. Its fields x_m,
// y_m and radius_m are the place.
void hide_in_place(SealedCampaign& made, sim::EffectSetting& patch, Dice& dice) {
  const sim::Disc disc = place_of_patch(made.driven, patch.parameters.at("radius_m"), dice);
  patch.parameters["x_m"] = disc.x_m;
  patch.parameters["y_m"] = disc.y_m;
  sim::Soil soft = made.driven.soils.find(kSoil)->second.mean;
  sim::apply_in_region({&patch, 1}, 0, soft);
  made.driven.soils.emplace(kSoftSoil, distribution(kSoftSoil, soft));
  TableTerrain& terrain = made.driven.terrains[0];
  const dem::GridGeometry& grid = terrain.ground->geometry();
  const auto cells = static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.columns);
  std::vector<std::uint8_t> known(cells, 0);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const Eigen::Vector2d centre = grid.centre_m({row, column});
      known[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
            static_cast<std::size_t>(column)] = disc.holds(centre.x(), centre.y()) ? 1 : 0;
    }
  terrain.soil_map = std::make_shared<dem::SoilMap>(
      grid, std::vector<std::int16_t>(cells, 1), std::move(known),
      std::vector<dem::SoilClass>{{1, std::string(kSoftSoil), std::string(kSoftSoil)}});
  made.place = disc;
}

void hide(const Order& order, SealedCampaign& made, Dice& dice) {
  for (const std::string_view name : order.effects) {
    sim::EffectSetting& effect =
        made.hidden.emplace_back(hidden_effect(name, order.size, dice.bits(), *made.driven.rover));
    if (sim::find_effect(name)->region != nullptr) {
      hide_in_place(made, effect, dice);
    } else {
      made.driven.effects.push_back(effect);
    }
  }
}

sim::DriveSensors sensors() {
  sim::DriveSensors sensors;
  sensors.position_m.noise = 0.003;
  sensors.attitude_rad.noise = rad_from_deg(0.2);
  sensors.current_a.noise = 0.003;
  sensors.current_a.relative_noise = 0.02;
  sensors.sinkage_m.noise = 0.001;
  sensors.sinkage_m.interval_s = 10.0;
  return sensors;
}

SealedCampaign made_of(const Order& order, const std::string& name, std::uint64_t key,
                       const std::shared_ptr<const sim::RoverModel>& rover) {
  Dice dice(key);
  SealedCampaign made;
  made.name = name;
  made.size = order.size;
  made.nominal = order.nominal;
  made.kind = order.rough ? "rough" : "tilt";
  made.recorded.bus_voltage_v = rover->drive.bus_voltage_v;
  made.recorded.sinkage = order.sinkage;
  made.recorded.more_columns = false;
  DriveTable& table = made.driven;
  table.name = name;
  table.rover = rover;
  table.seed = dice.bits();
  table.sensors = sensors();
  table.options.sample_interval_s = 2.0;
  const TrueSoil& row = kSoils[order.small ? 0 : dice.below(kSoils.size())];
  made.soil = row.name;
  const double spread = spread_of(order.nominal);
  const sim::Soil truth = soil_of(row);
  const sim::Soil believed = believed_soil(truth, spread, dice);
  table.soils.emplace(kSoil, distribution(kSoil, truth));
  if (order.rough) {
    add_rough_field(table, dice);
  } else {
    for (const int tilt_deg : order.small ? std::vector{0, 10, 15} : std::vector{0, 5, 10, 15, 18})
      add_tilted_table(table, tilt_deg, order.small, dice);
  }
  made.believed = table;
  made.believed.soils.clear();
  made.believed.soils.emplace(kSoil, distribution(kSoil, believed));
  sim::RoverModel real = *rover;
  real.drive.torque_constant_nm_per_a *= std::exp(0.01 * spread * std::clamp(dice.normal(), -2.0, 2.0));
  if (!order.heavy_wheels) real.masses = kNearlyWeightless;
  table.rover = std::make_shared<const sim::RoverModel>(std::move(real));
  hide(order, made, dice);
  if (!order.temperature)
    for (DriveEntry& entry : made.believed.entries) entry.motor_temp_c.reset();
  return made;
}

double drawn_size(Dice& dice) {
  const double u = dice.uniform();
  return u < 0.2 ? 0.5 : u < 0.7 ? 1.0 : 2.0;
}

std::vector<Order> each(Dice& dice) {
  using Names = std::vector<std::string_view>;
  std::vector<Order> orders;
  for (const std::string_view name : hidden_effects()) orders.push_back({Names{name}, drawn_size(dice)});
  for (const auto& pair : {Names{sim::kGrousers.name, sim::kWheelRadius.name},
                           Names{sim::kSlipSinkage.name, sim::kComOffset.name},
                           Names{sim::kMultipass.name, sim::kGearboxFriction.name}})
    orders.push_back({pair, 1.0});
  for (const std::string_view nominal : {"true", "near", "usual", "far"})
    orders.push_back({.effects = {}, .size = 1.0, .nominal = nominal});
  for (Order& order : orders) {
    const auto hides = [&](const auto& which) {
      return std::any_of(order.effects.begin(), order.effects.end(),
                         [&](std::string_view name) { return which(*sim::find_effect(name)); });
    };
    order.rough =
        dice.uniform() < 0.3 || hides([](const sim::Effect& effect) { return effect.region != nullptr; });
    order.sinkage = dice.uniform() > 0.12;
    order.temperature = dice.uniform() > 0.12 ||
                        hides([](const sim::Effect& effect) { return effect.reads_motor_temperature; });
  }
  return orders;
}

}  // namespace

std::span<const std::string_view> sealed_sets() {
  return kSets;
}

std::vector<SealedCampaign> sealed_campaigns(std::string_view set, std::uint64_t seed,
                                             const std::shared_ptr<const sim::RoverModel>& rover) {
  const std::uint64_t key = random_key(seed, fnv1a(set == "smoke" ? "smoke" : "each"));
  Dice dice(key);
  std::vector<Order> orders =
      set != "smoke"
          ? each(dice)
          : std::vector<Order>{{.effects = {}, .size = 1.0, .nominal = "true", .small = true},
                               {.effects = {sim::kGearboxFriction.name}, .size = 2.0, .small = true}};
  dice.shuffle(orders);
  for (Order& order : orders) order.heavy_wheels = set == "each_heavy_wheels";
  std::vector<SealedCampaign> campaigns;
  for (std::size_t i = 0; i < orders.size(); ++i)
    campaigns.push_back(made_of(orders[i], fmt::format("d{:02}", i + 1), random_key(key, i + 1), rover));
  return campaigns;
}

}  // namespace slipway::campaign
