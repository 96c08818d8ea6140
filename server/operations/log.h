#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace slipway::server {

enum class LogLevel { kDebug, kInfo, kWarning, kError };
enum class LogForm { kText, kJson };

// One thing that an event says of itself.
struct LogField {
  std::string_view name;
  std::variant<std::string, double> value;
};

// What the service writes to standard error: an event a line, of this level and above. Before the first call
// it is text from kInfo on.
void set_log(LogForm form, LogLevel from);

// One event, "worker_died", with its fields. As JSON it is one object, {"time": ..., "level": ..., "event":
// ...} with the fields beside them. Thread-safe; characters that would end the line or colour a terminal are
// escaped.
void log_event(LogLevel level, std::string_view event, std::initializer_list<LogField> fields = {});

// JSON in which characters that end a line for an editor, or turn or hide what stands beside them, are
// escaped.
std::string with_hidden_escaped(std::string_view json);

// The trace id of a traceparent header [W3C Trace Context]; nothing where it is malformed.
std::optional<std::string> trace_id_of(std::string_view traceparent);

}  // namespace slipway::server
