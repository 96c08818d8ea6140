#include "api/documents/prediction_answer.h"

#include "api/documents/check_answer.h"
#include "api/documents/drive_series.h"
#include "api/documents/dynamic_series.h"
#include "api/documents/prediction_request.h"
#include "api/json/writer.h"

namespace slipway::api::json {

std::string write_prediction_answer(const PredictionAnswer& answer) {
  Writer w;
  w.begin_object().text("format", "prediction/1");
  w.text("terrain", answer.request.terrain).text("rover", answer.request.rover);
  write_provenance(w, answer.provenance);
  w.key("request").raw(write_prediction_request(answer.request));
  w.key("summary").begin_object();
  write_drive_figures(w, answer.prediction);
  if (answer.dynamic) write_dynamic_figures(w, *answer.dynamic);
  w.end_object();
  write_decision(w, answer.decision);
  write_outcomes(w, answer.prediction, answer.provenance);
  w.key("routes")
      .begin_object()
      .text("type", "FeatureCollection")
      .text("crs_name", answer.provenance.crs_name);
  w.text("coordinates", "x_m, y_m, height_m in the terrain's projected system");
  w.key("features").begin_array().begin_object().text("type", "Feature").whole("id", 1);
  write_line(w, answer.prediction);
  w.key("properties").begin_object();
  write_drive_figures(w, answer.prediction);
  write_stations(w, answer.prediction, answer.provenance);
  if (answer.dynamic) write_dynamic_drive(w, *answer.dynamic);
  w.end_object().end_object().end_array().end_object().end_object();
  return w.take();
}

}  // namespace slipway::api::json
