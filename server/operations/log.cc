#include "server/operations/log.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>

#include "api/jobs/job.h"
#include "api/json/writer.h"
#include "core/utc.h"

namespace slipway::server {
namespace {

std::atomic<LogForm> form{LogForm::kText};

constexpr std::array<spdlog::level::level_enum, 4> kLevels{spdlog::level::debug, spdlog::level::info,
                                                           spdlog::level::warn, spdlog::level::err};
constexpr std::array<std::string_view, 4> kNames{"debug", "info", "warning", "error"};

spdlog::logger& logger() {
  static const auto logger = [] {
    auto made =
        std::make_shared<spdlog::logger>("slipway", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    made->set_pattern("%v");
    made->flush_on(spdlog::level::debug);
    return made;
  }();
  return *logger;
}

std::string as_json(LogLevel level, std::string_view event, std::initializer_list<LogField> fields) {
  api::json::Writer w;
  w.begin_object()
      .text("time", utc_text(now_ms()))
      .text("level", kNames[static_cast<std::size_t>(level)])
      .text("event", event);
  for (const LogField& field : fields) {
    if (const auto* const number = std::get_if<double>(&field.value))
      w.significant(field.name, *number);
    else
      w.text(field.name, std::get<std::string>(field.value));
  }
  w.end_object();
  return w.take();
}

// A JSON string has no character that a terminal acts on.
std::string quoted(const std::string& text) {
  api::json::Writer w;
  w.text(text);
  return w.take();
}

std::string as_text(LogLevel level, std::string_view event, std::initializer_list<LogField> fields) {
  std::string line =
      fmt::format("{} {} {}", utc_text(now_ms()), kNames[static_cast<std::size_t>(level)], event);
  for (const LogField& field : fields) {
    if (const auto* const number = std::get_if<double>(&field.value))
      line += fmt::format(" {}={:g}", field.name, *number);
    else
      line += fmt::format(" {}={}", field.name, quoted(std::get<std::string>(field.value)));
  }
  return line;
}

}  // namespace

void set_log(LogForm wanted, LogLevel from) {
  form = wanted;
  logger().set_level(kLevels[static_cast<std::size_t>(from)]);
}

void log_event(LogLevel level, std::string_view event, std::initializer_list<LogField> fields) {
  const auto at = kLevels[static_cast<std::size_t>(level)];
  if (!logger().should_log(at)) return;
  logger().log(at, form == LogForm::kJson ? as_json(level, event, fields) : as_text(level, event, fields));
}

std::optional<std::string> trace_id_of(std::string_view traceparent) {
  // "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01".
  constexpr std::size_t kBegin = 3, kLength = 32;
  if (traceparent.size() < kBegin + kLength + 1 || traceparent[2] != '-' ||
      traceparent[kBegin + kLength] != '-')
    return std::nullopt;
  const std::string_view id = traceparent.substr(kBegin, kLength);
  const auto hexadecimal = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  if (!std::all_of(id.begin(), id.end(), hexadecimal) || id.find_first_not_of('0') == std::string_view::npos)
    return std::nullopt;
  return std::string(id);
}

}  // namespace slipway::server
