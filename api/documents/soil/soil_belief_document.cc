#include "api/documents/soil/soil_belief_document.h"

#include <algorithm>
#include <cmath>

#include "api/documents/soil/soil_estimate_request.h"
#include "api/files/soil_tests_csv.h"
#include "api/files/terrain_site.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "core/angle.h"
#include "core/largest_exact_whole.h"
#include "core/version.h"

namespace slipway::api::json {
namespace {

constexpr std::size_t kMaxSoils = 50, kMaxTables = 10;

// One of the file's soils before its tables were read.
struct ReadSoil {
  std::vector<std::string> tables;
  std::string label;  // of its rows; empty: all are its own
  std::optional<double> max_slip_angle_deg;
  SlipOfTests slip;
};

void read_soil(ObjectReader object, BeliefSoil& soil, ReadSoil& read) {
  if (!object.is_object()) return;
  object.text("name", kRequired, {.most = 64, .is_name = true}, soil.name);
  object.texts("tests", kRequired, {1, kMaxTables}, {}, read.tables);
  object.text("soil", kOptional, {.most = 64, .is_name = true}, read.label);
  object.number("max_slip_angle_deg", kOptional, {"deg", 0.0, 90.0}, read.max_slip_angle_deg);
  if (auto estimate = object.object("estimate", kRequired))
    read.slip = read_soil_estimate(*estimate, soil.estimate);
  object.refuse_unknown();
}

void read_ensemble(ObjectReader& reader, std::string_view key, gap::EnsembleOptions& options) {
  auto object = reader.object(key, kOptional);
  if (!object) return;
  object->whole("walkers", kOptional, std::size_t{4}, std::size_t{1000}, options.walkers);
  object->whole("burn_in", kOptional, std::size_t{0}, std::size_t{1'000'000}, options.burn_in);
  object->whole("steps", kOptional, std::size_t{1}, std::size_t{1'000'000}, options.steps);
  object->whole("every", kOptional, std::size_t{1}, std::size_t{1'000'000}, options.every);
  object->refuse_unknown();
}

void read_options(ObjectReader& reader, gap::SoilBeliefOptions& options) {
  std::vector<std::string> between;
  reader.texts("between", kRequired, {1, 10}, {.most = 128}, between);
  for (std::size_t k = 0; k < between.size(); ++k) {
    if (auto parameter = gap::free_parameter(between[k]))
      options.between.push_back(std::move(*parameter));
    else
      reader.faults().push_back(
          {child_pointer("/between", k), unknown_name("parameter", between[k], gap::free_parameter_names())});
  }
  reader.numbers("usual_spread", kOptional, {between.size(), between.size()}, {"", 0.0, 100.0, true},
                 options.usual_spread);
  read_ensemble(reader, "of_soil", options.of_soil);
  read_ensemble(reader, "of_hierarchy", options.of_hierarchy);
  std::uint64_t seed = options.of_soil.seed;
  reader.whole("seed", kOptional, std::uint64_t{0}, kMaxExactWhole, seed);
  options.of_soil.seed = options.of_hierarchy.seed = seed;
}

Result<void> read_tables(const ReadSoil& read, const std::filesystem::path& data_folder, BeliefSoil& soil) {
  for (const std::string& table : read.tables) {
    const auto bytes = read_data_file(data_folder / table);
    if (!bytes) return fail(bytes.error());
    auto tests = read_wheel_tests_csv(table, *bytes);
    if (!tests) return fail(tests.error());
    for (gap::WheelObservation& test : *tests) {
      if (!read.label.empty() && test.soil != read.label) continue;
      if (!read.label.empty()) test.soil.clear();
      if (read.max_slip_angle_deg &&
          std::abs(deg_from_rad(test.test.slip_angle_rad)) > *read.max_slip_angle_deg + 1e-9)
        continue;
      test.test.slip_definition = read.slip.definition;
      test.test.slip_radius = read.slip.radius;
      soil.estimate.data.wheels.push_back(std::move(test));
    }
  }
  return {};
}

void write_numbers(Writer& w, const gap::NumbersOfSoil& numbers) {
  const auto list = [&](std::string_view key, const Eigen::VectorXd& values) {
    w.key(key).begin_array();
    for (const double value : values) w.significant(value);
    w.end_array();
  };
  w.begin_object();
  list("mean", numbers.mean);
  list("std", numbers.std);
  w.key("correlation").begin_array();
  for (Eigen::Index k = 0; k < numbers.correlation.rows(); ++k) {
    w.begin_array();
    for (const double value : numbers.correlation.row(k)) w.significant(value);
    w.end_array();
  }
  w.end_array().end_object();
}

void write_interval(Writer& w, const gap::SpreadInterval& interval) {
  w.begin_object().significant("median", interval.median).significant("low", interval.low);
  w.significant("high", interval.high).end_object();
}

void write_tested(Writer& w, const gap::TestedSoilBelief& soil) {
  w.begin_object().text("name", soil.name).whole("readings", static_cast<std::int64_t>(soil.readings));
  w.significant("residual_variance", soil.residual_variance);
  w.significant("effective_samples", soil.effective_samples);
  write_numbers(w.key("alone"), soil.alone);
  write_numbers(w.key("among"), soil.among);
  write_numbers(w.key("left_out").begin_object().key("predicted"), soil.left_out.predicted);
  w.key("rank").begin_array();
  for (const double rank : soil.left_out.rank) w.significant(rank);
  w.end_array().key("readings_held").begin_object();
  w.whole("by_belief", static_cast<std::int64_t>(soil.left_out.readings.by_belief));
  w.whole("by_file", static_cast<std::int64_t>(soil.left_out.readings.by_file));
  w.end_object().end_object().end_object();
}

}  // namespace

Result<SoilBeliefRequest> load_soil_belief_request(const std::filesystem::path& file,
                                                   const std::filesystem::path& data_folder) {
  const auto bytes = read_data_file(file);
  if (!bytes) return fail(bytes.error());
  const auto document = parse(*bytes);
  if (!document) return fail(document.error());
  std::vector<Fault> faults;
  SoilBeliefRequest request;
  std::vector<ReadSoil> read;
  ObjectReader reader(*document, "", faults);
  std::size_t format = 0;
  reader.choice("format", kRequired, {"soil-belief/1"}, format);
  reader.text("summary", kRequired, {.most = 1000}, request.summary);
  read_options(reader, request.options);
  for (const Element& element : reader.list("soils", kRequired, {2, kMaxSoils}))
    read_soil(reader.object(element), request.soils.emplace_back(), read.emplace_back());
  reader.refuse_unknown();
  if (!faults.empty()) return fail(ErrorCode::kUnreadableData, summary_of(faults), faults);
  for (std::size_t k = 0; k < read.size(); ++k)
    if (auto done = read_tables(read[k], data_folder, request.soils[k]); !done) return fail(done.error());
  return request;
}

std::string soil_belief_document(const SoilBeliefRequest& request, const gap::SoilBelief& belief) {
  Writer w;
  w.begin_object().text("format", "soil-belief-answer/1").text("summary", request.summary);
  w.key("between").begin_array();
  for (std::size_t k = 0; k < belief.between.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    w.begin_object().text("name", belief.between[k].name).boolean("logarithm", belief.logarithm[k]);
    w.significant("mean", belief.all.mean[at]).significant("mean_std", belief.all.mean_std[at]);
    write_interval(w.key("spread"), belief.all.spread[k]);
    w.end_object();
  }
  w.end_array();
  write_interval(w.key("correlation"), belief.all.correlation);
  write_numbers(w.key("next_soil"), belief.all.next);
  w.key("soils").begin_array();
  for (const gap::TestedSoilBelief& soil : belief.soils) write_tested(w, soil);
  w.end_array().key("provenance").begin_object().text("version", version());
  w.whole("seed", static_cast<std::int64_t>(request.options.of_soil.seed)).end_object().end_object();
  return w.take();
}

}  // namespace slipway::api::json
