#include "server/operations/log.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <iterator>
#include <memory>
#include <optional>

#include "api/jobs/job.h"
#include "api/json/writer.h"
#include "core/text_encoding.h"
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

// The code of a character that ends a line or turns or hides what stands beside it; nothing of any other.
std::optional<unsigned> hidden_code(std::string_view character) {
  const auto bits = [&](std::size_t i, unsigned mask) {
    return static_cast<unsigned>(static_cast<unsigned char>(character[i])) & mask;
  };
  unsigned code = 0;
  if (character.size() == 1) code = bits(0, 0xFFU);
  if (character.size() == 2) code = bits(0, 0x1FU) << 6U | bits(1, 0x3FU);
  if (character.size() == 3) code = bits(0, 0x0FU) << 12U | bits(1, 0x3FU) << 6U | bits(2, 0x3FU);
  const bool hides = (code >= 0x7F && code <= 0x9F) || (code >= 0x200B && code <= 0x200F) ||
                     (code >= 0x2028 && code <= 0x202E) || (code >= 0x2060 && code <= 0x206F) ||
                     code == 0xFEFF;
  return hides ? std::optional(code) : std::nullopt;
}

// A JSON string has no character that a terminal acts on.
std::string quoted(const std::string& text) {
  api::json::Writer w;
  w.text(text);
  return with_hidden_escaped(w.take());
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

std::string with_hidden_escaped(std::string_view json) {
  std::string out;
  for (std::size_t i = 0; i < json.size();) {
    const std::size_t length = std::max<std::size_t>(1, length_of_character(json, i));
    const std::string_view character = json.substr(i, length);
    if (const auto code = hidden_code(character))
      fmt::format_to(std::back_inserter(out), "\\u{:04x}", *code);
    else
      out += character;
    i += length;
  }
  return out;
}

void set_log(LogForm wanted, LogLevel from) {
  form = wanted;
  logger().set_level(kLevels[static_cast<std::size_t>(from)]);
}

void log_event(LogLevel level, std::string_view event, std::initializer_list<LogField> fields) {
  const auto at = kLevels[static_cast<std::size_t>(level)];
  if (!logger().should_log(at)) return;
  logger().log(at, form == LogForm::kJson ? with_hidden_escaped(as_json(level, event, fields))
                                          : as_text(level, event, fields));
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
