#include "soil_contact_model.h"

#include <algorithm>
#include <cmath>

namespace slipway::gap_benchmark {
namespace {

constexpr double kElastic_pa_m = 2e8;     // stiffness of unloading; more than a hundred times Bekker's
constexpr double kDisplacedShare = 0.25;  // of the volume that a wheel presses in; the rest is compacted
constexpr double kMinSpeed_m_s = 1e-6;    // of nodes through the contact, also under a wheel at rest
constexpr double kMinLength_m = 1e-6;     // of a patch

// A strip of the contact.
struct Strip {
  SoilNode node;           // that the wheel meets, with the heap on it
  double pressed_m = 0.0;  // depth of the lowest point below the surface without the heap
  double depth_m = 0.0;    // depth below the heap; 0 without contact
  double before_m = 0.0;   // length of the contact before the lowest point
  double behind_m = 0.0;   // length of the contact behind it
};

// The contact of one wheel, without its motion.
class Patch {
 public:
  Patch(double radius_m, double width_m, double depth_m, const ContactSoil& soil, int strips)
      : r_(radius_m), soil_(soil) {
    std::vector<SoilNode> met = soil.met;
    if (met.empty()) met.resize(static_cast<std::size_t>(strips));
    across_m_ = width_m / static_cast<double>(met.size());
    const double lowest = highest_level(met) - std::max(depth_m, 0.0);
    double pressed = 0.0;
    for (const SoilNode& node : met) {
      strips_.push_back({.node = node, .pressed_m = std::max(node.level_m() - lowest, 0.0)});
      pressed += strips_.back().pressed_m / static_cast<double>(met.size());
    }
    // The displaced soil goes to the front and the two sides of the patch in proportion to their lengths.
    // Soil in front is pushed again, so that a node enters h = f (z + h) higher than it was.
    const double length = chord(pressed);
    const double to_front = kDisplacedShare * width_m / (width_m + 2.0 * length);
    beside_m2_ = kDisplacedShare * pressed * width_m * length / (width_m + 2.0 * length);
    for (Strip& strip : strips_) {
      const double heap = strip.pressed_m * to_front / (1.0 - to_front);
      strip.node.origin_m += heap;
      strip.depth_m = strip.pressed_m + heap;
      strip.before_m = chord(strip.depth_m);
    }
    // The elastic length behind the lowest point belongs to the patch whose width makes the pressure.
    for (int pass = 0; pass < 3; ++pass) {
      stiffness_ = soil.stiffness * (1.0 + soil.modulus_ratio_m / narrow_side_m()) /
                   (1.0 + soil.modulus_ratio_m / width_m);
      for (Strip& strip : strips_) strip.behind_m = chord(lowest_pressure(strip) / kElastic_pa_m);
    }
  }

  const std::vector<Strip>& strips() const { return strips_; }
  double across_m() const { return across_m_; }
  double beside_m2() const { return beside_m2_; }  // cross-section of what is heaped on either side

  // The pressure on a node that is being pressed, `rise_m` above the lowest point.
  double pressing(const Strip& strip, double rise_m) const {
    const double elastic = std::max(strip.depth_m - rise_m, 0.0), sinkage = elastic + strip.node.plastic_m;
    return std::min(kElastic_pa_m * elastic,
                    std::max(strip.node.yield_pa, stiffness_ * std::pow(sinkage, soil_.n)));
  }
  double lowest_pressure(const Strip& strip) const { return pressing(strip, 0.0); }
  // The pressure on a node that springs back from its deepest point; where it is not positive, contact has
  // ended.
  double springing_back(const Strip& strip, double rise_m, double least_rise_m) const {
    return pressing(strip, least_rise_m) - kElastic_pa_m * (rise_m - least_rise_m);
  }

 private:
  double chord(double depth_m) const {
    const double depth = std::clamp(depth_m, 0.0, 0.98 * r_);
    return std::sqrt(depth * (2.0 * r_ - depth));
  }
  // 2 area / perimeter of the rectangle that has the area and the mean length of the patch.
  double narrow_side_m() const {
    double sum = 0.0, squares = 0.0;
    for (const Strip& strip : strips_) {
      const double length = strip.before_m + strip.behind_m;
      sum += length;
      squares += length * length;
    }
    if (sum < kMinLength_m) return kMinLength_m;
    const double length = squares / sum, width = sum / length * across_m_;
    return width * length / (width + length);
  }

  double r_;
  const ContactSoil& soil_;
  std::vector<Strip> strips_;
  double across_m_ = 0.0, beside_m2_ = 0.0, stiffness_ = 0.0;
};

// A strip's nodes from the front to the back.
class NodePath {
 public:
  struct Node {
    double x_m = 0.0, sine = 0.0, cosine = 1.0;  // ahead of the axle; of the angle on the rim
    double length_m = 0.0, rise_m = 0.0;         // of the rim over it; above the lowest point
    // For a node that entered at the front: its pressure, and the distance that the rim has slid over it.
    double sigma_pa = 0.0, slid_m = 0.0;
  };

  NodePath() = default;
  NodePath(const Patch& patch, const Strip& strip, double radius_m, const ContactGrid& grid, double rim_m_s,
           double ahead_m_s)
      : front_m_(strip.before_m) {
    nodes_.reserve(static_cast<std::size_t>(grid.nodes_before + grid.nodes_behind + grid.nodes_far_behind));
    const double slowness = 1.0 / std::max(ahead_m_s, kMinSpeed_m_s);
    double x = front_m_, slid = 0.0;
    const auto add = [&](double step) {
      Node node{.x_m = x - 0.5 * step, .sine = (x - 0.5 * step) / radius_m};
      node.cosine = std::sqrt(1.0 - node.sine * node.sine);
      node.length_m = step / node.cosine;
      node.rise_m = radius_m * (1.0 - node.cosine);
      node.sigma_pa =
          node.x_m > 0.0 ? patch.pressing(strip, node.rise_m) : patch.springing_back(strip, node.rise_m, 0.0);
      const double sliding = step * slowness * (rim_m_s - ahead_m_s * node.cosine);
      node.slid_m = slid + 0.5 * sliding;
      nodes_.push_back(node);
      slid += sliding;
      x -= step;
    };
    const double far = std::max(strip.before_m - strip.behind_m, 0.0);
    for (int i = 0; i < grid.nodes_before; ++i) add(strip.before_m / grid.nodes_before);
    for (int i = 0; i < grid.nodes_behind; ++i) add(strip.behind_m / grid.nodes_behind);
    for (int i = 0; i < grid.nodes_far_behind; ++i) add(far / grid.nodes_far_behind);
  }

  const std::vector<Node>& nodes() const { return nodes_; }
  // The distance that the rim slides over a node between the front and x, linear between nodes.
  double slid_until(double x_m) const {
    const auto next =
        std::find_if(nodes_.begin(), nodes_.end(), [&](const Node& node) { return node.x_m <= x_m; });
    if (next == nodes_.end()) return nodes_.back().slid_m;
    const Node last = next == nodes_.begin() ? Node{.x_m = front_m_} : *(next - 1);
    return last.slid_m + (next->slid_m - last.slid_m) * (last.x_m - x_m) / (last.x_m - next->x_m);
  }

 private:
  double front_m_ = 0.0;
  std::vector<Node> nodes_;
};

}  // namespace

SoilContactModel::SoilContactModel(double radius_m, double width_m, const ContactGrid& grid)
    : radius_m_(radius_m), width_m_(width_m), grid_(grid) {}

WheelLoads SoilContactModel::loads(double depth_m, const WheelMotion& motion, const ContactSoil& soil) const {
  // All quantities are in the direction of travel, so that a wheel that drives backwards is mirrored.
  const double way = motion.forward_m_s != 0.0 ? motion.forward_m_s : motion.rate_rad_s;
  const double sense = way < 0.0 ? -1.0 : 1.0;
  const double ahead = sense * motion.forward_m_s, left = sense * motion.left_m_s;
  const double rim = sense * motion.rate_rad_s * radius_m_;
  const double passing = std::max(ahead, kMinSpeed_m_s);

  const Patch patch(radius_m_, width_m_, depth_m, soil, grid_.strips);
  double normal = 0.0, pull = 0.0, side = 0.0, torque = 0.0;
  NodePath path;
  const SoilNode* laid_through = nullptr;  // strips of the same soil have the same path
  for (std::size_t s = 0; s < patch.strips().size(); ++s) {
    const Strip& strip = patch.strips()[s];
    if (strip.depth_m <= 0.0) continue;
    if (!laid_through || *laid_through != strip.node) {
      path = NodePath(patch, strip, radius_m_, grid_, rim, ahead);
      laid_through = &strip.node;
    }
    // Nodes enter at the front, or at the side toward which the wheel moves.
    const double from_right = (static_cast<double>(s) + 0.5) * patch.across_m();
    const double to_side = left > 0.0 ? width_m_ - from_right : from_right;
    const double until_side = left == 0.0 ? 2.0 * radius_m_ : to_side * passing / std::abs(left);
    for (const NodePath::Node& node : path.nodes()) {
      const double entry = std::min(strip.before_m, node.x_m + until_side);
      // Nodes that enter at the side behind the lowest point are pressed as deep as at that point.
      double sigma = node.sigma_pa;
      if (entry < 0.0) {
        const double least_rise = radius_m_ - std::sqrt(radius_m_ * radius_m_ - entry * entry);
        sigma = patch.springing_back(strip, node.rise_m, least_rise);
      }
      if (sigma <= 0.0) continue;
      const double j_x = node.slid_m - (entry < strip.before_m ? path.slid_until(entry) : 0.0);
      const double j_y = left * (entry - node.x_m) / passing;
      const double j = std::sqrt(j_x * j_x + j_y * j_y) + 1e-15;
      // Contact behind the lowest point ends without a jump.
      const double cohesion = node.x_m > 0.0 ? soil.cohesion_pa : std::min(soil.cohesion_pa, sigma);
      const double strength = cohesion + sigma * soil.tan_phi;
      const double tau = strength * (1.0 - std::exp(-j / soil.shear_modulus_m));
      const double tau_x = tau * j_x / j, tau_y = tau * j_y / j;
      const double area = node.length_m * patch.across_m();
      normal += area * (sigma * node.cosine + tau_x * node.sine);
      pull += area * (tau_x * node.cosine - sigma * node.sine);
      side -= area * tau_y;
      torque += area * tau_x * radius_m_;
    }
  }
  return {.normal_n = normal, .pull_n = sense * pull, .side_n = sense * side, .torque_nm = sense * torque};
}

Rut SoilContactModel::rut(double depth_m, const ContactSoil& soil) const {
  const Patch patch(radius_m_, width_m_, depth_m, soil, grid_.strips);
  Rut rut;
  for (const Strip& strip : patch.strips()) {
    SoilNode node = strip.node;
    if (strip.depth_m > 0.0) {
      const double pressure = patch.lowest_pressure(strip);
      node.plastic_m += strip.depth_m - pressure / kElastic_pa_m;
      node.yield_pa = std::max(node.yield_pa, pressure);
    }
    rut.across.push_back(node);
  }
  // A berm whose flanks have the friction angle is represented by a bar of its mean height.
  const double crest = std::sqrt(patch.beside_m2() * soil.tan_phi);
  rut.berm_height_m = 0.5 * crest;
  rut.berm_width_m = crest > 0.0 ? 2.0 * crest / soil.tan_phi : 0.0;
  return rut;
}

}  // namespace slipway::gap_benchmark
