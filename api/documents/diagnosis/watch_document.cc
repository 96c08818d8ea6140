#include "api/documents/diagnosis/watch_document.h"

#include <cmath>

#include "api/documents/diagnosis/diagnosis_document.h"
#include "api/json/writer.h"
#include "core/version.h"

namespace slipway::api::json {

std::string watch_document(const gap::DriveWatch& watch) {
  Writer w;
  w.begin_object().text("format", "watch/1").text("campaign", watch.campaign);
  w.text("version", version()).text("hash", watch.campaign_fingerprint);
  w.key("reference").begin_object().text("campaign", watch.reference);
  w.text("hash", watch.reference_fingerprint);
  w.whole("drives", static_cast<std::int64_t>(watch.learnt_drives)).end_object();
  w.significant("alpha", watch.alpha).boolean("changed", watch.alarm.has_value());
  if (watch.alarm) {
    w.key("alarm").begin_object().text("drive", watch.drives[*watch.alarm].id);
    w.text("since", watch.drives[watch.since].id);
    w.text("diagnosed_since", watch.drives[watch.diagnosed_since].id);
    w.whole("delay_drives", static_cast<std::int64_t>(*watch.alarm - watch.since + 1));
    w.key("onset").begin_object().text("first", watch.drives[watch.onset.first].id);
    w.text("last", watch.drives[watch.onset.last].id);
    w.significant("share", watch.onset.share).end_object().end_object();
  }
  w.key("drives").begin_array();
  for (std::size_t d = 0; d < watch.drives.size(); ++d) {
    const gap::WatchedDrive& drive = watch.drives[d];
    w.begin_object().text("id", drive.id).whole("windows", static_cast<std::int64_t>(drive.windows));
    if (std::isfinite(drive.log10_evidence)) w.significant("log10_evidence", drive.log10_evidence);
    w.boolean("alarm", drive.alarm);
    if (d < watch.onset_shares.size()) w.significant("onset_share", watch.onset_shares[d]);
    w.end_object();
  }
  w.end_array().key("causes").begin_array();
  for (const gap::ChangeShare& cause : watch.causes)
    w.begin_object().text("name", cause.name).significant("share", cause.share).end_object();
  w.end_array().text("causes_are", "first_pointer");
  w.boolean("awaits_another", watch.awaits_another()).texts("notes", watch.notes);
  w.text("answer", watch.diagnosis ? "diagnosis" : "changed");
  if (watch.diagnosis) w.key("diagnosis").raw(diagnosis_document(*watch.diagnosed, *watch.diagnosis));
  w.end_object();
  return w.take();
}

}  // namespace slipway::api::json
