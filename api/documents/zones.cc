#include "api/documents/zones.h"

#include <cmath>
#include <utility>

#include "api/requests/plan_request.h"

namespace slipway::api::json {
namespace {

// Twice the signed area of the ring [shoelace formula].
double doubled_area(const planner::Polygon& ring) {
  double sum = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d& a = ring[i];
    const Eigen::Vector2d& b = ring[(i + 1) % ring.size()];
    // Relative to the first corner: map coordinates are large and areas small.
    sum += (a.x() - ring[0].x()) * (b.y() - ring[0].y()) - (b.x() - ring[0].x()) * (a.y() - ring[0].y());
  }
  return sum;
}

bool read_corner(const Element& element, Eigen::Vector2d& out, std::vector<Fault>& faults) {
  if (!element.value->is(JsonValue::Kind::kArray) || element.value->elements.size() != 2) {
    faults.push_back({element.pointer, "is " + describe(*element.value) + ", must be [x_m, y_m]"});
    return false;
  }
  const NumberRule rule{"m", -1e8, 1e8};
  const bool x =
      read_number(element.value->elements[0], element.pointer + "/0", "x_m", rule, out.x(), faults);
  const bool y =
      read_number(element.value->elements[1], element.pointer + "/1", "y_m", rule, out.y(), faults);
  return x && y;
}

void read_ring(const Element& element, planner::Polygon& ring, std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  const JsonValue& value = *element.value;
  const std::size_t count = value.elements.size();
  if (!value.is(JsonValue::Kind::kArray) || count < 3 || count > RequestLimits::kKeepOutCorners) {
    faults.push_back({element.pointer, "is " + describe(value) + ", must be a list of 3 to " +
                                           std::to_string(RequestLimits::kKeepOutCorners) +
                                           " corners [x_m, y_m]"});
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector2d corner = Eigen::Vector2d::Zero();
    read_corner({&value.elements[i], child_pointer(element.pointer, i)}, corner, faults);
    ring.push_back(corner);
  }
  if (faults.size() != before) return;
  if (ring.front() == ring.back()) ring.pop_back();  // a ring closed as GeoJSON closes it
  constexpr double kMinArea_m2 = 1e-4;
  if (ring.size() < 3 || std::abs(doubled_area(ring)) < 2.0 * kMinArea_m2) {
    faults.push_back({element.pointer, "encloses no area"});
  }
}

void write_rings(Writer& w, std::string_view key, const std::vector<planner::Polygon>& rings) {
  w.key(key).begin_array();
  for (const planner::Polygon& ring : rings) {
    w.begin_array();
    for (const Eigen::Vector2d& corner : ring)
      w.begin_array().exact(corner.x()).exact(corner.y()).end_array();
    w.end_array();
  }
  w.end_array();
}

}  // namespace

void read_zones(ObjectReader& reader, std::vector<planner::Polygon>& keep_out,
                std::vector<planner::Polygon>& keep_in, std::vector<Fault>& faults) {
  for (const auto& [key, rings] : {std::pair{"keep_out", &keep_out}, {"keep_in", &keep_in}})
    for (const Element& element : reader.list(key, kOptional, {0, RequestLimits::kKeepOuts}))
      read_ring(element, rings->emplace_back(), faults);
}

void write_zones(Writer& w, const std::vector<planner::Polygon>& keep_out,
                 const std::vector<planner::Polygon>& keep_in) {
  write_rings(w, "keep_out", keep_out);
  if (!keep_in.empty()) write_rings(w, "keep_in", keep_in);
}

}  // namespace slipway::api::json
