#include "api/files/soil_file.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <utility>

#include "api/files/assumed_soil.h"
#include "api/files/model_fields.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "core/angle.h"

namespace slipway::api::json {
namespace {

constexpr std::size_t kMaxSoils = 1000;
// The uncertain quantities, in the order of sim::SoilNormals.
constexpr std::array<std::string_view, sim::kSoilDims> kQuantities{"stiffness", "n", "cohesion",
                                                                   "friction_angle", "shear_modulus"};

// The keys of a soil's spread, in the order of sim::SoilNormals; slip_ratio is that of a slip curve.
constexpr std::array kSpread{
    ModelField<sim::SoilStd>{
        .field = {"stiffness_ratio", "1", "of both moduli of sinkage, over their mean", 0.0, 2.0},
        .number = [](sim::SoilStd& s) -> double& { return s.stiffness_ratio; }},
    ModelField<sim::SoilStd>{.field = {"n", "1", "of the exponent of sinkage", 0.0, 1.0},
                             .number = [](sim::SoilStd& s) -> double& { return s.n; }},
    ModelField<sim::SoilStd>{.field = {"cohesion_pa", "Pa", "of the cohesion", 0.0, 1e6},
                             .number = [](sim::SoilStd& s) -> double& { return s.cohesion_pa; }},
    ModelField<sim::SoilStd>{.field = {"friction_angle_deg", "deg", "of the friction angle", 0.0, 30.0},
                             .number = [](sim::SoilStd& s) -> double& { return s.friction_angle_rad; },
                             .kept_as = KeptAs::kRadians},
    ModelField<sim::SoilStd>{
        .field = {"shear_modulus_ratio", "1", "of both shear moduli, over their mean", 0.0, 2.0},
        .number = [](sim::SoilStd& s) -> double& { return s.shear_modulus_ratio; }},
};
// Of what is drawn on its own, where a file gives it.
constexpr std::array kClosureSpread{
    ModelField<sim::SoilStd>{.field = {"c1", "1", "of c1", 0.0, 1.0},
                             .number = [](sim::SoilStd& s) -> double& { return s.c1; },
                             .presence = FieldPresence::kOptional,
                             .writing = FieldWriting::kUnlessInitial},
    ModelField<sim::SoilStd>{.field = {"c2", "1", "of c2", 0.0, 1.0},
                             .number = [](sim::SoilStd& s) -> double& { return s.c2; },
                             .presence = FieldPresence::kOptional,
                             .writing = FieldWriting::kUnlessInitial},
};
constexpr std::array kSlipSpread{
    ModelField<sim::SoilStd>{.field = {"slip_ratio", "1", "of the slip at every slope", 0.0, 1.0},
                             .number = [](sim::SoilStd& s) -> double& { return s.slip_ratio; }},
};

// In the order of sim::AlternativesBy.
const std::vector<std::string_view> kAlternativesBy{"everywhere", "unit", "patch"};

std::span<const ModelField<sim::SoilStd>> spread_of(const sim::Soil& soil) {
  if (soil.slip_curve != nullptr) return kSlipSpread;
  return kSpread;
}

void read_std(ObjectReader& reader, const sim::Soil& mean, sim::SoilStd& std) {
  auto object = reader.object("std", kRequired);
  if (!object) return;
  read_fields(*object, spread_of(mean), kRequired, std);
  if (mean.slip_curve == nullptr)
    read_fields(*object, std::span<const ModelField<sim::SoilStd>>(kClosureSpread), kOptional, std);
  object->refuse_unknown();
}

void read_correlation(ObjectReader& reader, sim::SoilDistribution& soil) {
  std::vector<std::string_view> names(kQuantities.begin(), kQuantities.end());
  names.insert(names.end(), {"c1", "c2"});
  for (const Element& element : reader.list("correlation", kOptional, {0, 11})) {
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
    const bool closures = first >= kQuantities.size() && second >= kQuantities.size();
    if (closures && std::abs(value) < 1.0) {
      soil.closure_correlation = value;
    } else if (closures) {
      pair.fault("value", "value must be within (-1, 1): c1 and c2 do not follow from each other");
    } else if (first >= kQuantities.size() || second >= kQuantities.size()) {
      pair.fault("second", "c1 and c2 are correlated with each other alone");
    } else {
      soil.correlation(static_cast<int>(first), static_cast<int>(second)) = value;
      soil.correlation(static_cast<int>(second), static_cast<int>(first)) = value;
    }
  }
}

// What must hold between the numbers of a soil whose numbers were read.
void check_soil(ObjectReader& reader, const sim::SoilDistribution& soil) {
  constexpr double kNarrowestWheel_m = 0.05;
  constexpr double kWidestWheel_m = 0.6;
  if (soil.mean.slip_curve != nullptr) return;
  for (const double width_m : {kNarrowestWheel_m, kWidestWheel_m}) {
    if (soil.mean.pressure_form({.width_m = width_m, .radius_m = width_m}).stiffness > 0.0) continue;
    if (soil.mean.pressure_law.row == nullptr)
      reader.fault("k_phi", "k_c / b + k_phi is not positive for a wheel of width b = " +
                                std::to_string(width_m) + " m");
    else
      reader.fault("pressure_law", "the pressure is not positive under a wheel of width b = " +
                                       std::to_string(width_m) + " m");
  }
  if (soil.mean.cohesion_pa == 0.0 && soil.std.cohesion_pa > 0.0) {
    reader.fault("std", "cohesion_pa = 0 Pa can't have a spread: draws are log-normal");
  }
  if ((soil.mean.c1 <= 0.0 && soil.std.c1 > 0.0) || (soil.mean.c2 <= 0.0 && soil.std.c2 > 0.0))
    reader.fault("std", "c1 and c2 have a spread only where they are above 0: draws are log-normal");
  if (Eigen::LLT<sim::SoilCorrelation>(soil.correlation).info() != Eigen::Success) {
    reader.fault("correlation",
                 "the correlations contradict each other: their matrix is not positive definite");
  }
}

// The row that "pressure_law" or "shear_law" names, with the numbers of its fields; no row where none or the
// first is named, by which a soil is computed anyway.
template <class Law>
const Law* read_law(ObjectReader& reader, std::string_view key, std::span<const Law* const> laws,
                    sim::LawParameters& parameters) {
  auto object = reader.object(key, kOptional);
  if (!object) return nullptr;
  std::vector<std::string_view> names;
  for (const Law* law : laws) names.push_back(law->name);
  std::size_t chosen = 0;
  if (!object->choice("name", kRequired, names, chosen)) return nullptr;  // its other keys depend on it
  const Law& law = *laws[chosen];
  for (std::size_t i = 0; i < law.fields.size(); ++i) {
    const Field& field = law.fields[i];
    object->number(field.name, kRequired, {field.unit, field.lowest, field.highest}, parameters[i]);
  }
  object->refuse_unknown();
  return chosen == 0 ? nullptr : &law;
}

void read_soil_parameters(ObjectReader& reader, const sim::SoilFormat& format, Presence less_known,
                          bool with_laws, sim::Soil& soil) {
  const std::size_t before = reader.faults().size();
  if (with_laws) {
    soil.pressure_law.row =
        read_law(reader, "pressure_law", format.laws.pressure, soil.pressure_law.parameters);
    soil.shear_law.row = read_law(reader, "shear_law", format.laws.shear, soil.shear_law.parameters);
  }
  const bool law_is_unclear = reader.faults().size() > before;
  for (const sim::SoilField& row : format.fields) {
    if (is_bekker_modulus(row) && law_is_unclear) {
      reader.member(row.field.name, kOptional);  // whether it must be there is not known
      continue;
    }
    if (is_bekker_modulus(row) && soil.pressure_law.row != nullptr) continue;
    // Where nothing is said of it, shear across is like shear along.
    if (row.field.name == "shear_modulus_y_m") soil.shear_modulus_y_m = soil.shear_modulus_x_m;
    read_field(reader, row, less_known, soil);
  }
}

void read_slip_curve(ObjectReader& reader, sim::Soil& soil) {
  auto object = reader.object("slip_curve", kRequired);
  if (!object) return;
  constexpr CountRule kCount{2, 200};
  const auto in_radians = [](std::vector<double> degrees) {
    for (double& value : degrees) value = rad_from_deg(value);
    return degrees;
  };
  const auto column = [&](std::string_view key, const NumberRule& rule) {
    std::vector<double> values;
    object->numbers(key, kRequired, kCount, rule, values);
    return values;
  };
  const std::size_t before = reader.faults().size();
  sim::SlipCurve curve;
  curve.slope_rad = in_radians(column("slope_deg", {"deg", -45.0, 45.0}));
  curve.slip_ratio = column("slip", {"1", -1.0, 1.0});
  curve.cross_slope_rad = in_radians(column("cross_slope_deg", {"deg", 0.0, 45.0}));
  curve.side_slip_rad = in_radians(column("side_slip_deg", {"deg", -89.0, 89.0}));
  object->refuse_unknown();
  if (reader.faults().size() == before)
    for (const Fault& fault : sim::faults_of(curve))
      reader.faults().push_back({reader.pointer() + fault.pointer, fault.message});
  soil.slip_curve = std::make_shared<const sim::SlipCurve>(std::move(curve));
}

void read_shares(ObjectReader& reader, sim::SpreadShares& shares) {
  auto object = reader.object("spread_shares", kOptional);
  if (!object) return;
  constexpr NumberRule kShare{"1", 0.0, 1.0};
  object->number("everywhere", kRequired, kShare, shares.everywhere);
  object->number("unit", kRequired, kShare, shares.unit);
  object->number("patch", kRequired, kShare, shares.patch);
  object->refuse_unknown();
  constexpr double kRounding = 1e-6;
  if (std::abs(shares.everywhere + shares.unit + shares.patch - 1.0) > kRounding)
    reader.fault("spread_shares", "the shares must add up to 1");
}

// Names alone: the soils that they name may stand in other files.
void read_alternatives(ObjectReader& reader, sim::SoilDistribution& soil) {
  constexpr NumberRule kWeight{"1", 0.0, 1e6};
  double pressure = 0.0, strength = 0.0, on_units = 0.0;
  bool in_patches = false;
  std::size_t whole = 0;
  for (const Element& element : reader.list("alternatives", kOptional, {1, 100})) {
    ObjectReader row(*element.value, element.pointer, reader.faults());
    sim::SoilAlternative& alternative = soil.alternatives.emplace_back();
    row.text("soil", kRequired, {.most = 64, .is_name = true}, alternative.name);
    if (element.value->find("weight") != nullptr) {
      row.number("weight", kRequired, kWeight, alternative.strength_weight);
      alternative.pressure_weight = alternative.strength_weight;
      ++whole;
    } else {
      row.number("pressure_weight", kOptional, kWeight, alternative.pressure_weight);
      row.number("strength_weight", kOptional, kWeight, alternative.strength_weight);
    }
    row.boolean("in_patches", kOptional, alternative.in_patches);
    row.refuse_unknown();
    pressure += alternative.pressure_weight;
    on_units += alternative.in_patches ? 0.0 : alternative.strength_weight;
    in_patches = in_patches || alternative.in_patches;
    strength += alternative.strength_weight;
  }
  if (!soil.alternatives.empty() && (pressure <= 0.0 || strength <= 0.0))
    reader.fault("alternatives", "the weights of pressure and of strength must each have a positive sum");
  if (whole > 0 && whole < soil.alternatives.size())
    reader.fault("alternatives",
                 "either all alternatives have a weight, and a draw is one of these soils, or none has");
  soil.drawn_apart = whole == 0;
  auto by = static_cast<std::size_t>(soil.alternatives_by);
  reader.choice("alternatives_by", kOptional, kAlternativesBy, by);
  soil.alternatives_by = static_cast<sim::AlternativesBy>(by);
  if (in_patches && (soil.alternatives_by != sim::AlternativesBy::kUnit || whole == 0 || on_units <= 0.0))
    reader.fault(
        "alternatives",
        "in_patches is for alternatives with a weight and by unit, of which some are not in patches");
  reader.number("alternatives_spread", kOptional, {"1", 0.0, 5.0}, soil.alternatives_spread);
  reader.number("patches_spread", kOptional, {"1", 0.0, 5.0}, soil.patches_spread);
  if (soil.patches_spread > 0.0 && !in_patches)
    reader.fault("patches_spread", "patches_spread is for alternatives of which some are in patches");
}

void read_soil(const Element& element, const sim::SoilFormat& format, sim::SoilDistribution& soil,
               std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  JsonValue whole = *element.value;
  const std::vector<std::string> assumed = give_what_is_assumed(whole);
  ObjectReader reader(whole, element.pointer, faults);
  reader.text("name", kRequired, {.most = 64, .is_name = true}, soil.name);
  reader.text("summary", kRequired, {.most = 500}, soil.summary);
  reader.text("source", kRequired, {.most = 500}, soil.source);
  reader.texts("assumed", kOptional, {0, 30}, {.most = 500}, soil.assumed);
  soil.assumed.insert(soil.assumed.end(), assumed.begin(), assumed.end());
  if (whole.find("slip_curve") != nullptr) {
    read_slip_curve(reader, soil.mean);
  } else {
    read_soil_parameters(reader, format, kRequired, true, soil.mean);
    read_correlation(reader, soil);
  }
  read_std(reader, soil.mean, soil.std);
  reader.number("correlation_length_m", kRequired, {"m", 0.0, 1e4, true}, soil.correlation_length_m);
  read_shares(reader, soil.shares);
  reader.number("slip_error", kOptional, {"1", 0.0, 2.0}, soil.slip_error);
  read_alternatives(reader, soil);
  reader.refuse_unknown();
  if (faults.size() == before) check_soil(reader, soil);
}

template <class Choice>
void write_law(Writer& w, std::string_view key, const Choice& choice) {
  if (choice.row == nullptr) return;
  w.key(key).begin_object().text("name", choice.row->name);
  for (std::size_t i = 0; i < choice.row->fields.size(); ++i)
    w.exact(choice.row->fields[i].name, choice.parameters[i]);
  w.end_object();
}

void write_degrees(Writer& w, std::string_view key, const std::vector<double>& radians) {
  w.key(key).begin_array();
  for (const double value : radians) w.angle_deg(value);
  w.end_array();
}

void write_slip_curve(Writer& w, const sim::SlipCurve& curve) {
  w.key("slip_curve").begin_object();
  write_degrees(w, "slope_deg", curve.slope_rad);
  w.key("slip").begin_array();
  for (const double slip : curve.slip_ratio) w.exact(slip);
  w.end_array();
  write_degrees(w, "cross_slope_deg", curve.cross_slope_rad);
  write_degrees(w, "side_slip_deg", curve.side_slip_rad);
  w.end_object();
}

void write_correlation(Writer& w, const sim::SoilDistribution& soil) {
  const sim::SoilCorrelation& correlation = soil.correlation;
  w.key("correlation").begin_array();
  for (int i = 0; i < sim::kSoilDims; ++i) {
    for (int j = i + 1; j < sim::kSoilDims; ++j) {
      if (correlation(i, j) == 0.0) continue;
      w.begin_object().text("first", kQuantities[static_cast<std::size_t>(i)]);
      w.text("second", kQuantities[static_cast<std::size_t>(j)])
          .exact("value", correlation(i, j))
          .end_object();
    }
  }
  if (soil.closure_correlation != 0.0) {
    w.begin_object().text("first", "c1").text("second", "c2");
    w.exact("value", soil.closure_correlation).end_object();
  }
  w.end_array();
}

}  // namespace

void read_campaign_soil(ObjectReader& reader, Presence less_known, sim::Soil& soil) {
  for (const std::string_view key : {"pressure_law", "shear_law", "slip_curve"})
    if (reader.member(key, kOptional) != nullptr)
      reader.fault(key,
                   std::string(key) +
                       " stands in a soil file only: drives are diagnosed on soils with Bekker's law and "
                       "Janosi and Hanamoto's");
  read_soil_parameters(reader, sim::soil_format(), less_known, false, soil);
}

std::vector<sim::SoilDistribution> read_soils(ObjectReader& reader, std::string_view key, Presence presence,
                                              const sim::SoilFormat& format) {
  std::vector<sim::SoilDistribution> soils;
  for (const Element& element : reader.list(key, presence, {1, kMaxSoils}))
    read_soil(element, format, soils.emplace_back(), reader.faults());
  return soils;
}

Result<std::vector<sim::SoilDistribution>> read_soil_file(std::string_view bytes,
                                                          const sim::SoilFormat& allowed) {
  const auto document = parse(bytes);
  if (!document) return fail(document.error());
  std::vector<Fault> faults;
  ObjectReader reader(*document, "", faults);
  std::size_t format = 0;
  reader.choice("format", kRequired, {"soils/1"}, format);
  std::vector<sim::SoilDistribution> soils = read_soils(reader, "soils", kRequired, allowed);
  reader.refuse_unknown();
  if (!faults.empty()) return fail(ErrorCode::kUnreadableData, summary_of(faults), faults);
  return soils;
}

void write_soil(Writer& w, const sim::SoilDistribution& soil, const sim::SoilFormat& format) {
  const sim::Soil& mean = soil.mean;
  w.begin_object().text("name", soil.name).text("summary", soil.summary).text("source", soil.source);
  w.texts("assumed", soil.assumed);
  if (mean.slip_curve != nullptr) {
    write_slip_curve(w, *mean.slip_curve);
  } else {
    write_law(w, "pressure_law", mean.pressure_law);
    write_law(w, "shear_law", mean.shear_law);
    for (const sim::SoilField& row : format.fields)
      if (mean.pressure_law.row == nullptr || !is_bekker_modulus(row)) write_field(w, row, mean);
  }
  write_fields(w.key("std").begin_object(), spread_of(mean), soil.std);
  if (mean.slip_curve == nullptr)
    write_fields(w, std::span<const ModelField<sim::SoilStd>>(kClosureSpread), soil.std);
  w.end_object();
  if (mean.slip_curve == nullptr) write_correlation(w, soil);
  w.exact("correlation_length_m", soil.correlation_length_m);
  if (const sim::SpreadShares usual; soil.shares.everywhere != usual.everywhere ||
                                     soil.shares.unit != usual.unit || soil.shares.patch != usual.patch) {
    w.key("spread_shares").begin_object().exact("everywhere", soil.shares.everywhere);
    w.exact("unit", soil.shares.unit).exact("patch", soil.shares.patch).end_object();
  }
  if (soil.slip_error > 0.0) w.exact("slip_error", soil.slip_error);
  if (!soil.alternatives.empty()) {
    w.key("alternatives").begin_array();
    for (const sim::SoilAlternative& alternative : soil.alternatives) {
      w.begin_object().text("soil", alternative.name);
      if (soil.drawn_apart)
        w.exact("pressure_weight", alternative.pressure_weight)
            .exact("strength_weight", alternative.strength_weight);
      else
        w.exact("weight", alternative.strength_weight);
      if (alternative.in_patches) w.boolean("in_patches", true);
      w.end_object();
    }
    w.end_array().text("alternatives_by", kAlternativesBy[static_cast<std::size_t>(soil.alternatives_by)]);
    if (soil.alternatives_spread > 0.0) w.exact("alternatives_spread", soil.alternatives_spread);
    if (soil.patches_spread > 0.0) w.exact("patches_spread", soil.patches_spread);
  }
  w.end_object();
}

}  // namespace slipway::api::json
