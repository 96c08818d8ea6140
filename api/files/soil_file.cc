#include "api/files/soil_file.h"

#include <Eigen/Cholesky>
#include <array>

#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"

namespace slipway::api::json {
namespace {

constexpr std::size_t kMostSoils = 1000;
// The uncertain quantities, in the order of sim::SoilNormals.
constexpr std::array<std::string_view, sim::kSoilDims> kQuantities{"stiffness", "n", "cohesion",
                                                                   "friction_angle", "shear_modulus"};

void read_std(ObjectReader& reader, sim::SoilStd& std) {
  auto object = reader.object("std", kRequired);
  if (!object) return;
  object->number("stiffness_ratio", kRequired, {"1", 0.0, 2.0}, std.stiffness_ratio);
  object->number("n", kRequired, {"1", 0.0, 1.0}, std.n);
  object->number("cohesion_pa", kRequired, {"Pa", 0.0, 1e6}, std.cohesion_pa);
  object->angle_deg("friction_angle_deg", kRequired, {"deg", 0.0, 30.0}, std.friction_angle_rad);
  object->number("shear_modulus_ratio", kRequired, {"1", 0.0, 2.0}, std.shear_modulus_ratio);
  object->refuse_unknown();
}

void read_correlation(ObjectReader& reader, sim::SoilCorrelation& correlation) {
  const std::vector<std::string_view> names(kQuantities.begin(), kQuantities.end());
  for (const Element& element : reader.list("correlation", kOptional, {0, 10})) {
    ObjectReader pair(*element.value, element.pointer, reader.faults());
    std::size_t first = 0;
    std::size_t second = 0;
    double value = 0.0;
    const bool good = pair.choice("first", kRequired, names, first) &
                      pair.choice("second", kRequired, names, second) &
                      pair.number("value", kRequired, {"1", -1.0, 1.0}, value);
    pair.refuse_unknown();
    if (!good) continue;
    if (first == second) {
      pair.fault("second", "second must be another quantity than first");
      continue;
    }
    correlation(static_cast<int>(first), static_cast<int>(second)) = value;
    correlation(static_cast<int>(second), static_cast<int>(first)) = value;
  }
}

// What must hold between the numbers of a soil whose numbers were read.
void check_soil(ObjectReader& reader, const sim::SoilDistribution& soil) {
  constexpr double kNarrowestWheel_m = 0.05;
  constexpr double kWidestWheel_m = 0.6;
  for (const double width_m : {kNarrowestWheel_m, kWidestWheel_m}) {
    if (soil.mean.pressure.stiffness(width_m) > 0.0) continue;
    reader.fault("k_phi", "k_c / b + k_phi is not positive for a wheel of width b = " +
                              std::to_string(width_m) + " m");
  }
  if (soil.mean.cohesion_pa == 0.0 && soil.std.cohesion_pa > 0.0) {
    reader.fault("std", "cohesion_pa = 0 Pa can't have a spread: draws are log-normal");
  }
  if (Eigen::LLT<sim::SoilCorrelation>(soil.correlation).info() != Eigen::Success) {
    reader.fault("correlation",
                 "the correlations contradict each other: their matrix is not positive definite");
  }
}

void read_soil(const Element& element, sim::SoilDistribution& soil, std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  ObjectReader reader(*element.value, element.pointer, faults);
  reader.text("name", kRequired, {.most = 64, .is_name = true}, soil.name);
  reader.text("summary", kRequired, {.most = 500}, soil.summary);
  reader.text("source", kRequired, {.most = 500}, soil.source);
  reader.texts("assumed", kRequired, {0, 30}, {.most = 500}, soil.assumed);
  read_soil_parameters(reader, kRequired, soil.mean);
  read_std(reader, soil.std);
  read_correlation(reader, soil.correlation);
  reader.number("correlation_length_m", kRequired, {"m", 0.0, 1e4, true}, soil.correlation_length_m);
  reader.refuse_unknown();
  if (faults.size() == before) check_soil(reader, soil);
}

}  // namespace

void read_soil_parameters(ObjectReader& reader, Presence less_known, sim::Soil& soil) {
  reader.number("k_c", kRequired, {"N/m^(n+1)", -1e10, 1e10}, soil.pressure.k_c);
  reader.number("k_phi", kRequired, {"N/m^(n+2)", -1e10, 1e11}, soil.pressure.k_phi);
  reader.number("n", kRequired, {"1", 0.1, 3.0}, soil.pressure.n);
  reader.number("cohesion_pa", kRequired, {"Pa", 0.0, 1e6}, soil.cohesion_pa);
  reader.angle_deg("friction_angle_deg", kRequired, {"deg", 0.0, 60.0, true}, soil.friction_angle_rad);
  reader.number("shear_modulus_x_m", kRequired, {"m", 0.0, 1.0, true}, soil.shear_modulus_x_m);
  soil.shear_modulus_y_m = soil.shear_modulus_x_m;
  reader.number("shear_modulus_y_m", kOptional, {"m", 0.0, 1.0, true}, soil.shear_modulus_y_m);
  reader.number("density_kg_m3", less_known, {"kg/m^3", 100.0, 5000.0}, soil.density_kg_m3);
  reader.number("c1", less_known, {"1", 0.0, 1.0}, soil.c1);
  reader.number("c2", less_known, {"1", -1.0, 1.0}, soil.c2);
  reader.number("n1", kOptional, {"1", 0.0, 2.0}, soil.n1);
  reader.number("n1_skid", kOptional, {"1", 0.0, 2.0}, soil.n1_skid);
  reader.number("n1_lateral", kOptional, {"1", 0.0, 2.0}, soil.n1_lateral);
  reader.number("exit_angle_ratio", kOptional, {"1", 0.0, 1.0}, soil.exit_angle_ratio);
  reader.number("shear_coupling", kOptional, {"1", 0.0, 1.0}, soil.shear_coupling);
}

std::vector<sim::SoilDistribution> read_soils(ObjectReader& reader, std::string_view key, Presence presence) {
  std::vector<sim::SoilDistribution> soils;
  for (const Element& element : reader.list(key, presence, {1, kMostSoils}))
    read_soil(element, soils.emplace_back(), reader.faults());
  return soils;
}

Result<std::vector<sim::SoilDistribution>> read_soil_file(std::string_view bytes) {
  const auto document = parse(bytes);
  if (!document) return fail(document.error());
  std::vector<Fault> faults;
  ObjectReader reader(*document, "", faults);
  std::size_t format = 0;
  reader.choice("format", kRequired, {"soils/1"}, format);
  std::vector<sim::SoilDistribution> soils = read_soils(reader, "soils", kRequired);
  reader.refuse_unknown();
  if (!faults.empty()) return fail(ErrorCode::kUnreadableData, summary_of(faults), faults);
  return soils;
}

void write_soil(Writer& w, const sim::SoilDistribution& soil) {
  const sim::Soil& mean = soil.mean;
  w.begin_object().text("name", soil.name).text("summary", soil.summary).text("source", soil.source);
  w.texts("assumed", soil.assumed);
  w.exact("k_c", mean.pressure.k_c).exact("k_phi", mean.pressure.k_phi).exact("n", mean.pressure.n);
  w.exact("cohesion_pa", mean.cohesion_pa).angle_deg("friction_angle_deg", mean.friction_angle_rad);
  w.exact("shear_modulus_x_m", mean.shear_modulus_x_m).exact("shear_modulus_y_m", mean.shear_modulus_y_m);
  w.exact("density_kg_m3", mean.density_kg_m3).exact("c1", mean.c1).exact("c2", mean.c2).exact("n1", mean.n1);
  w.exact("n1_skid", mean.n1_skid).exact("n1_lateral", mean.n1_lateral);
  w.exact("exit_angle_ratio", mean.exit_angle_ratio).exact("shear_coupling", mean.shear_coupling);
  w.key("std").begin_object().exact("stiffness_ratio", soil.std.stiffness_ratio).exact("n", soil.std.n);
  w.exact("cohesion_pa", soil.std.cohesion_pa).angle_deg("friction_angle_deg", soil.std.friction_angle_rad);
  w.exact("shear_modulus_ratio", soil.std.shear_modulus_ratio).end_object();
  w.key("correlation").begin_array();
  for (int i = 0; i < sim::kSoilDims; ++i) {
    for (int j = i + 1; j < sim::kSoilDims; ++j) {
      if (soil.correlation(i, j) == 0.0) continue;
      w.begin_object().text("first", kQuantities[static_cast<std::size_t>(i)]);
      w.text("second", kQuantities[static_cast<std::size_t>(j)])
          .exact("value", soil.correlation(i, j))
          .end_object();
    }
  }
  w.end_array().exact("correlation_length_m", soil.correlation_length_m).end_object();
}

}  // namespace slipway::api::json
