#include "api/documents/prediction_answer.h"

#include "api/documents/check_answer.h"
#include "api/documents/drive_routes.h"
#include "api/documents/drive_series.h"
#include "api/documents/drive_so_far.h"
#include "api/documents/dynamic_series.h"
#include "api/documents/prediction_request.h"
#include "api/json/writer.h"

namespace slipway::api::json {

std::string write_prediction_answer(const PredictionAnswer& answer, StationDetail detail) {
  Writer w;
  w.begin_object().text("format", "prediction/1");
  w.text("terrain", answer.request.terrain).text("rover", answer.request.rover);
  write_provenance(w, answer.provenance);
  write_learnt_drive(w, answer.provenance.learnt, answer.request.drive);
  w.key("request").raw(write_prediction_request(answer.request));
  w.key("summary").begin_object();
  write_drive_figures(w, answer.prediction);
  if (answer.dynamic) write_dynamic_figures(w, *answer.dynamic);
  w.end_object();
  write_decision(w, answer.decision);
  write_outcomes(w, answer.prediction, answer.provenance, answer.request.drive.bars);
  write_position_uncertainty(w, answer.prediction, answer.request.drive.checks);
  write_route(w, answer.prediction, answer.provenance, detail, answer.dynamic ? &*answer.dynamic : nullptr);
  w.end_object();
  return w.take();
}

}  // namespace slipway::api::json
