#include "api/documents/soil/tuning_document.h"

#include <cmath>

#include "api/json/writer.h"
#include "core/angle.h"

namespace slipway::api::json {
namespace {

using gap::DriveTuning;

void write_number(Writer& w, const std::optional<double>& value) {
  if (value)
    w.significant(*value);
  else
    w.null();
}

void write_set(Writer& w, const DriveTuning& tuning, std::span<const double> x) {
  w.begin_object();
  for (std::size_t k = 0; k < x.size(); ++k) w.significant(tuning.sweep.names[k], x[k]);
  w.end_object();
}

void write_parameters(Writer& w, const campaign::TuneRequest& request) {
  w.key("parameters").begin_array();
  for (const gap::TunedParameter& p : request.parameters) {
    w.begin_object().text("name", p.sweep.name);
    w.text("unit", campaign::tuning_field(p.sweep.name).value_or(Field{}).unit);
    w.exact("lowest", p.sweep.lowest).exact("highest", p.sweep.highest);
    w.whole("coarse", p.sweep.coarse).whole("fine", p.sweep.fine).boolean("logarithmic", p.sweep.logarithmic);
    if (p.prior)
      w.key("prior").begin_object().exact("mean", p.prior->mean).exact("std", p.prior->std).end_object();
    w.end_object();
  }
  w.end_array();
}

void write_drives(Writer& w, const campaign::TableTuning& result) {
  w.key("drives").begin_array();
  for (const gap::MeasuredDrive& drive : result.drives) {
    w.begin_object().text("id", drive.name).significant("tilt_deg", deg_from_rad(drive.tilt_rad));
    w.whole("repeats", static_cast<std::int64_t>(drive.finals.size())).end_object();
  }
  w.end_array().texts("unmeasured", result.unmeasured);
}

void write_service(Writer& w, const DriveTuning& tuning, std::size_t point) {
  const gap::SlopeService& service = tuning.services[point];
  write_set(w.begin_object().key("set"), tuning, tuning.sweep.points[point].x);
  write_number(w.key("score"), tuning.sweep.points[point].score);
  w.key("tilts").begin_array();
  for (std::size_t k = 0; k < tuning.tilts.size(); ++k) {
    w.begin_object().significant("tilt_deg", deg_from_rad(tuning.tilts[k].tilt_rad));
    write_number(w.key("score"), service.scores[k]);
    w.significant("best_score", tuning.tilts[k].best_score).boolean("served", service.served[k]).end_object();
  }
  w.end_array();
  if (service.range) {
    w.significant("lowest_tilt_deg", deg_from_rad(service.range->lowest_rad));
    w.significant("highest_tilt_deg", deg_from_rad(service.range->highest_rad));
  }
  w.end_object();
}

void write_fit(Writer& w, const campaign::TableTuning& answer, const gap::TuningFit& result) {
  const DriveTuning& tuning = answer.tuning;
  const gap::LeastSquaresFit& fit = result.fit;
  w.begin_object().boolean("converged", fit.converged).significant("score", result.score);
  w.significant("noise", result.noise).significant("residual_variance", fit.residual_variance);
  w.key("beyond_loss_scale").begin_array();
  for (const std::size_t i : result.beyond) w.text(answer.drives[i].name);
  w.end_array();
  w.key("estimates").begin_array();
  for (std::size_t k = 0; k < fit.estimate.size(); ++k) {
    w.begin_object().text("name", tuning.sweep.names[k]).significant("value", fit.estimate[k]);
    write_number(w.key("std"), fit.standard_error(k));
    w.boolean("on_bound", fit.on_bound[k]).end_object();
  }
  w.end_array().key("correlation").begin_array();
  for (std::size_t j = 0; j < fit.estimate.size(); ++j) {
    w.begin_array();
    for (std::size_t k = 0; k < fit.estimate.size(); ++k) write_number(w, fit.correlation(j, k));
    w.end_array();
  }
  w.end_array().key("undetermined").begin_array();
  for (const gap::UndeterminedDirection& direction : fit.undetermined) w.text(direction.words);
  w.end_array().end_object();
}

void write_best(Writer& w, const campaign::TableTuning& result) {
  const DriveTuning& tuning = result.tuning;
  write_service(w.key("best_coarse"), tuning, tuning.sweep.best_coarse);
  write_service(w.key("best"), tuning, tuning.sweep.best);
  write_service(w.key("widest"), tuning, tuning.widest);
  w.key("best_of_tilts").begin_array();
  for (const gap::TiltGroup& group : tuning.tilts) {
    w.begin_object().significant("tilt_deg", deg_from_rad(group.tilt_rad));
    w.whole("drives", static_cast<std::int64_t>(group.drives.size()));
    write_service(w.key("serves"), tuning, group.best);
    if (group.fit) write_fit(w.key("least_squares"), result, *group.fit);
    w.end_object();
  }
  w.end_array();
}

void write_points(Writer& w, const DriveTuning& tuning) {
  w.key("sets").begin_array();
  for (std::size_t i = 0; i < tuning.sweep.points.size(); ++i) {
    const gap::SweepPoint& point = tuning.sweep.points[i];
    w.begin_object().key("x").begin_array();
    for (const double x : point.x) w.significant(x);
    write_number(w.end_array().key("score"), point.score);
    w.key("drives").begin_array();
    for (const auto& score : point.cases) write_number(w, score);
    w.end_array().whole("tilts_served", tuning.services[i].count).end_object();
  }
  w.end_array();
}

}  // namespace

std::string tuning_document(const campaign::DriveTable& table, const campaign::TuneRequest& request,
                            const campaign::TableTuning& result) {
  const gap::TuningOptions& options = request.options;
  Writer w;
  w.begin_object().text("format", "tuning/1").text("table", table.name).text("rung", "dynamic");
  w.text("soil", result.soil).exact("position_scale_m", options.scales.position_m);
  w.angle_deg("heading_scale_deg", options.scales.heading_rad);
  w.boolean("scales_are_errors", options.scales_are_errors);
  w.text("loss", gap::robust_loss_names()[static_cast<std::size_t>(options.loss)]);
  if (options.loss != gap::RobustLoss::kNone)
    w.exact("loss_scale", options.loss_scale.value_or(gap::usual_loss_scale(options.loss)));
  w.exact("within", options.within).exact("good_enough", options.good_enough);
  write_parameters(w, request);
  write_drives(w, result);
  write_best(w, result);
  if (result.tuning.fit) write_fit(w.key("least_squares"), result, *result.tuning.fit);
  write_points(w, result.tuning);
  w.end_object();
  return w.take() + "\n";
}

}  // namespace slipway::api::json
