#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "sim/soil/slip_curve.h"
#include "sim/soil/soil_law.h"

namespace slipway::sim {

// Bekker's moduli of sinkage. k_c and k_phi have units that depend on n, so they never travel alone.
// Pressure under a plate of width b at depth z: p = (k_c / b + k_phi) z^n  [Bekker 1956; ARTEMIS eq. 1].
struct BekkerModuli {
  double k_c = 0.0;    // N/m^(n+1); a fit may make it negative
  double k_phi = 0.0;  // N/m^(n+2)
  double n = 1.0;

  double stiffness(double width_m) const { return k_c / width_m + k_phi; }  // N/m^(n+2)
};

// A crust on the soil that carries until it breaks (effect duricrust): adds strength (z / depth) e^(1 - z /
// depth) to the pressure, its greatest at `depth_m`.
struct Duricrust {
  double strength_pa = 0.0;
  double depth_m = 0.01;
};

// A stiff layer at depth (effect hardpan): adds modulus (z - depth) to the pressure below it.
struct Hardpan {
  double modulus_pa_m = 0.0;
  double depth_m = 0.1;
};

// Soil that a turning rim and its cleats carry out from under a wheel (effect digging, digging_law.h).
struct Digging {
  double rim_share = 0.0;    // depth that a fast rim digs, over the radius
  double rim_slip = 0.65;    // slip travel at which half of it is dug
  double cleat_share = 0.0;  // what cleats dig per slip travel, over their height
  double cleat_limit = 4.8;  // slip travel that they never dig beyond
  double sideways = 0.0;     // how much more is dug by a wheel that moves straight sideways
};

// Soil that a wheel pushes before its front and its wall (effect ploughing, ploughing_law.h).
struct Ploughing {
  double front = 0.0, wall = 0.0;  // factors of passive earth pressure
  double heap = 0.0;               // what soil heaped up by a locked wheel adds, as a share
  double heap_slip = 1.8;          // rim's way over the wheel's at which the heap is down to 1 / e
  double wall_friction = 0.0;      // of soil on the wall
  double wall_turn = 0.15;         // speed of the wall along its plane, over the rim's
  double wall_yield = 1.1;         // sideways speed that turns the wall's friction away from its plane
};

// What the constitutive laws need of a soil.
struct Soil {
  // Bekker's law and, where `pressure_law` chooses another, its exponent n alone.
  BekkerModuli pressure;
  PressureLawChoice pressure_law;
  ShearLawChoice shear_law;
  double cohesion_pa = 0.0;
  double friction_angle_rad = 0.0;
  double shear_modulus_x_m = 0.01;  // Janosi-Hanamoto's K along the rolling direction
  double shear_modulus_y_m = 0.01;  // and across it
  double density_kg_m3 = 1500.0;
  // Angle of greatest normal stress: theta_m = (c1 + c2 |i|) theta_f [Wong & Reece 1967; ARTEMIS eq. 2].
  double c1 = 0.4;
  double c2 = 0.2;
  double n1 = 0.0;          // slip sinkage, n = n0 + n1 |i| [ARTEMIS eq. 22]; 0 unless the effect is on
  double n1_skid = 0.0;     // what it rises by besides from rolling to a locked wheel
  double n1_lateral = 0.0;  // and from straight to sideways motion, by sin^2(beta)
  // Contact behind the lowest point: theta_r = -exit_angle_ratio theta_f; 0 is perfectly plastic soil.
  double exit_angle_ratio = 0.0;
  // 0: longitudinal and lateral shear each mobilise the whole strength [ARTEMIS eq. 3, 6]; 1: their resultant
  // does [Mohr-Coulomb]; between, a blend.
  double shear_coupling = 0.0;
  // 0: the shear stress acts against the shear displacement; 1: against the rim's sliding over the soil, by
  // the resultant of the displacements (effect slip_directed_shear); between, a blend.
  double slip_directed = 0.0;

  // Effects; all off at these values. See the catalogue of effects.
  double bulldozing = 0.0;        // share of Rankine's passive pressure on the front
  double track_bulldozing = 0.0;  // share of that before a wheel that runs in a track
  double side_bulldozing = 0.0;   // share of Terzaghi's bearing capacity on the side walls
  // The slip angle at which most of that acts: early_mobilisation() in terzaghi.h.
  double side_mobilised_rad = 0.5 * M_PI;
  double rate_shear_exponent = 0.0;  // K ~ (rim speed / rate_shear_speed_m_s)^exponent
  double rate_shear_speed_m_s = 0.04;
  double multipass_stiffening = 0.0;  // a track is 1 + this times as stiff as fresh soil
  // Of that stiffening, the share by which cohesion is greater there, and shear stiffness (1 / K).
  double multipass_strengthening = 0.0;
  // How many times as cohesive and as stiff in shear this soil is, having been driven over. The pressure
  // under a wheel is not meant, which Reece's law makes of the cohesion too.
  double shear_strength_ratio = 1.0;
  // What inclined load takes from the pressure: p ~ exp(-softening (1 - progress)), inclined_load_law.h.
  double inclined_softening = 0.0;
  Digging digging;
  Ploughing ploughing;
  Duricrust crust;
  Hardpan hardpan;
  double gravity_exponent = 0.0;  // k_c and k_phi ~ (g / measured_gravity_m_s2)^exponent
  double measured_gravity_m_s2 = 9.81;
  double gravity_m_s2 = 3.71;  // of the place; the soil's weight presses back in bulldozing and on grousers

  // Ground that is known by the slip of rovers on slopes alone: nothing else of this soil is then known or
  // used.
  std::shared_ptr<const SlipCurve> slip_curve;
  double slip_deviation = 0.0;  // of a draw: its slip less the curve's

  double unit_weight_n_m3() const { return density_kg_m3 * gravity_m_s2; }
  // Pressure under a contact as a power of depth, whatever law is chosen; of a law that is none, one that
  // comes near.
  PressureForm pressure_form(const ContactSize& contact) const;
  // Multiplies all pressure at a depth by a ratio, whatever law is chosen.
  void stiffen(double ratio) {
    pressure.k_c *= ratio;
    pressure.k_phi *= ratio;
    pressure_law.stiffening *= ratio;
  }
  // Whether any of the closures of a digging, ploughing or inclined wheel is at work.
  bool has_closures() const {
    return slip_directed != 0.0 || inclined_softening != 0.0 || digging.rim_share != 0.0 ||
           digging.cleat_share != 0.0 || ploughing.front != 0.0 || ploughing.wall != 0.0;
  }
  bool has_bekker_law() const { return slip_curve == nullptr && pressure_law.row == nullptr; }
};

// One standard deviation of what is uncertain, in the same units as the mean. Stiffness and shear modulus are
// ratios to the mean: both Bekker moduli scale together.
struct SoilStd {
  double stiffness_ratio = 0.0;
  double n = 0.0;
  double cohesion_pa = 0.0;
  double friction_angle_rad = 0.0;
  double shear_modulus_ratio = 0.0;
  double c1 = 0.0, c2 = 0.0;  // of the angle of greatest normal stress
  double slip_ratio =
      0.0;  // of ground that is known by a slip curve: of the slip at every slope, in place of the others
};

constexpr int kSoilDims = 5;  // stiffness, n, cohesion, tan(friction angle), shear modulus
using SoilNormals = Eigen::Matrix<double, kSoilDims, 1>;
using SoilCorrelation = Eigen::Matrix<double, kSoilDims, kSoilDims>;
constexpr int kClosureDims = 2;  // c1 and c2, which are drawn as a pair of their own
using ClosureNormals = Eigen::Matrix<double, kClosureDims, 1>;

// How the spread about the mean is shared out among the levels of the ground, as shares of the variance that
// add up to 1. What is shared everywhere is one number for all ground of this soil; the rest changes from
// unit to unit and from patch to patch (see DrawnGround).
struct SpreadShares {
  double everywhere = 0.5;
  double unit = 0.3;
  double patch = 0.2;
};

// Over what ground one of the alternatives holds: all ground of the soil, a unit (kUnitLength_m), or a patch
// (the soil's correlation length).
enum class AlternativesBy { kEverywhere, kUnit, kPatch };

struct SoilDistribution;

// One of the soils that the ground may be.
struct SoilAlternative {
  std::string name;
  std::shared_ptr<const SoilDistribution> soil;  // of that name; without alternatives of its own
  double pressure_weight = 1.0;                  // for k_c, k_phi, n and the law of pressure
  double strength_weight = 1.0;                  // for everything else
  // Of alternatives by unit: it lies in patches within the units of the others, on its weight's share of the
  // ground.
  bool in_patches = false;
};

// What is believed of a soil: a mean, its spread and how far along the ground one draw holds. The five
// uncertain quantities are log-normal with these means and standard deviations (so every draw is a soil), and
// their logarithms have the given correlation; c1 and c2 are a log-normal pair with a correlation of its own.
// The slip of a slip curve is normal about it.
struct SoilDistribution {
  std::string name;                  // "mpf_drift"
  std::string summary;               // one line for people
  std::string source;                // "Zhurong paper, Table 3 [45]"
  std::vector<std::string> assumed;  // names of parameters that the source does not give
  Soil mean;
  SoilStd std;
  SoilCorrelation correlation = SoilCorrelation::Identity();
  double closure_correlation = 0.0;   // of the logarithms of c1 and c2, within (-1, 1)
  double correlation_length_m = 5.0;  // of a patch
  SpreadShares shares;
  // How far the slip on real ground of this kind is from the model's though the soil is right: ripples and
  // roughness below the map's cells, and the model itself. Standard deviation of the logarithm of the ratio
  // of ln(1 - slip), real over predicted; its levels are those of the spread.
  double slip_error = 0.0;
  // Where it is not known which soil the ground is, the soils that it may be; a draw is of one of these, and
  // mean and std above serve the prediction on the mean soil alone.
  std::vector<SoilAlternative> alternatives;
  AlternativesBy alternatives_by = AlternativesBy::kEverywhere;
  // How little is known of how common each of them is: the standard deviation from draw to draw of the
  // logarithm of each one's weight, the same for all ground of this soil.
  double alternatives_spread = 0.0;
  // How much the share of patches differs from unit to unit: the standard deviation of its logarithm, about
  // the same mean.
  double patches_spread = 0.0;
  // Sinkage under load and strength are drawn apart, since tables of soils often share one assumed stiffness
  // among rows whose strengths were measured one by one. Otherwise a draw is one of the soils as a whole, by
  // its strength's weight.
  bool drawn_apart = true;
};

// Turns standard normal numbers into one soil of the distribution. `normals` are independent; the correlation
// is applied here. A zero standard deviation leaves the mean exactly. `closures` are those of c1 and c2; at
// nought these are their medians.
Soil draw_soil(const SoilDistribution& distribution, const SoilNormals& normals,
               const ClosureNormals& closures = ClosureNormals::Zero());

// The direction of weakness, of length one: in equal parts less stiffness, cohesion and friction and more
// shear before the thrust is there. One standard deviation that way gives the planner's weak soil, and more
// slip on a slip curve.
SoilNormals towards_weakness();

}  // namespace slipway::sim
