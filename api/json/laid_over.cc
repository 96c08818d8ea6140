#include "api/json/laid_over.h"

#include "api/json/writer.h"

namespace slipway::api::json {
namespace {

void write_laid_over(Writer& w, const JsonValue& base, const JsonValue& over) {
  w.begin_object();
  for (std::size_t i = 0; i < base.keys.size(); ++i) {
    const JsonValue& below = base.elements[i];
    const JsonValue* const above = over.find(base.keys[i]);
    w.key(base.keys[i]);
    if (above == nullptr)
      write_value(w, below);
    else if (below.is(JsonValue::Kind::kObject) && above->is(JsonValue::Kind::kObject))
      write_laid_over(w, below, *above);
    else
      write_value(w, *above);
  }
  for (std::size_t i = 0; i < over.keys.size(); ++i)
    if (base.find(over.keys[i]) == nullptr) write_value(w.key(over.keys[i]), over.elements[i]);
  w.end_object();
}

}  // namespace

std::string laid_over(const JsonValue& base, const JsonValue& over) {
  Writer w;
  write_laid_over(w, base, over);
  return w.take();
}

}  // namespace slipway::api::json
