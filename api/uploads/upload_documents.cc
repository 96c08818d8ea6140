#include "api/uploads/upload_documents.h"

#include "api/json/writer.h"
#include "core/utc.h"

namespace slipway::api::json {
namespace {

void write(Writer& w, const Upload& upload) {
  w.begin_object().text("id", upload.id).text("name", upload.name).whole("bytes", upload.bytes);
  w.text("sent_at", utc_text(upload.origin.at_ms)).end_object();
}

}  // namespace

std::string write_upload(const Upload& upload) {
  Writer w;
  write(w, upload);
  return w.take();
}

std::string write_uploads(const std::vector<Upload>& uploads) {
  Writer w;
  w.begin_object().key("uploads").begin_array();
  for (const Upload& upload : uploads) write(w, upload);
  w.end_array().end_object();
  return w.take();
}

}  // namespace slipway::api::json
