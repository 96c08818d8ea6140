#include "api/documents/diagnosis/model_check_document.h"

#include "api/json/writer.h"
#include "gap/diagnosis/model/drive_window.h"

namespace slipway::api::json {
namespace {

void write_change(Writer& w, const gap::ErrorChange& change, double unit) {
  w.begin_object().significant("nominal", unit * change.nominal);
  w.significant("corrected", unit * change.corrected);
  w.key("down_percent").begin_object().significant("value", change.down_percent);
  if (change.down_interval) {
    w.key("interval_90").begin_array();
    w.significant(change.down_interval->low).significant(change.down_interval->high).end_array();
  }
  w.end_object().end_object();
}

void write_channel(Writer& w, const gap::ChannelCheck& check) {
  const double unit = gap::boundary_unit(check.channel);
  w.begin_object().text("channel", gap::name_of(check.channel)).text("unit", gap::unit_of(check.channel));
  w.text("slope", gap::name_of(check.slope));
  w.whole("values", static_cast<std::int64_t>(check.values));
  w.whole("drives", static_cast<std::int64_t>(check.drives));
  write_change(w.key("rms"), check.rms, unit);
  write_change(w.key("median_abs"), check.median, unit);
  w.significant("within_50", check.within_50).significant("within_90", check.within_90).end_object();
}

}  // namespace

std::string model_check_document(const ModelCheckAnswer& answer) {
  const gap::ModelCheck& check = answer.check;
  Writer w;
  w.begin_object().text("format", "model-check/1").text("campaign", answer.campaign);
  w.text("fingerprint", answer.fingerprint);
  w.key("model").begin_object().text("campaign", answer.corrected_with).text("rover", answer.rover);
  w.texts("soils", answer.soils).end_object();
  w.whole("seed", static_cast<std::int64_t>(answer.seed));
  w.whole("drives", static_cast<std::int64_t>(check.drives));
  w.whole("windows", static_cast<std::int64_t>(check.windows));
  w.key("unanswered").begin_object();
  w.whole("nominal", static_cast<std::int64_t>(check.unanswered_nominal));
  w.whole("corrected", static_cast<std::int64_t>(check.unanswered_corrected)).end_object();
  w.exact("level_within_deg", gap::kLevelWithin_deg).key("channels").begin_array();
  for (const gap::ChannelCheck& channel : check.channels) write_channel(w, channel);
  w.end_array().texts("notes", answer.notes).end_object();
  return w.take();
}

}  // namespace slipway::api::json
