#include "server/cli/inquiry/drive_request.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <initializer_list>
#include <optional>
#include <system_error>
#include <utility>

#include "api/documents/departure.h"
#include "api/documents/drive_so_far.h"
#include "api/files/soil_file.h"
#include "api/files/telemetry_csv.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/requests/plan_request.h"
#include "core/fault_words.h"
#include "core/utc.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/kernel_files.h"
#include "server/cli/inquiry/zone_option.h"
#include "server/cli/terminal/interruption.h"

namespace slipway::server {
namespace {

using api::json::Writer;

// Closes a file that was opened here; standard input is left open.
class Input {
 public:
  explicit Input(const std::string& path)
      : own_(path != "-"), descriptor_(own_ ? ::open(path.c_str(), O_RDONLY | O_CLOEXEC) : STDIN_FILENO) {}
  ~Input() {
    if (own_ && descriptor_ >= 0) ::close(descriptor_);
  }
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;
  int descriptor() const { return descriptor_; }

 private:
  bool own_;
  int descriptor_;
};

// An object of the numbers that were given; none where none was, unless it is wanted in any case.
void write_given(Writer& w, std::string_view key,
                 std::initializer_list<std::pair<std::string_view, std::optional<double>>> numbers,
                 bool in_any_case = false) {
  const auto given = [](const auto& number) { return number.second.has_value(); };
  if (!in_any_case && std::none_of(numbers.begin(), numbers.end(), given)) return;
  w.key(key).begin_object();
  for (const auto& [name, number] : numbers)
    if (number) w.exact(name, *number);
  w.end_object();
}

// Of what a request has as a whole in files of their own.
Result<void> write_files(Writer& w, const DriveOptions& drive) {
  const auto unusable = [](Error error) {
    if (error.code != ErrorCode::kCancelled) error.code = ErrorCode::kInvalidRequest;
    return fail(std::move(error));
  };
  if (!drive.drive_so_far.empty()) {
    const auto bytes = read_request(drive.drive_so_far);
    if (!bytes) return unusable(bytes.error());
    const auto so_far = api::read_telemetry_csv(*bytes, drive.drive_so_far);
    if (!so_far) return unusable(so_far.error());
    api::json::write_drive_so_far(w, *so_far);
  }
  if (drive.beliefs.empty()) return {};
  const auto bytes = read_request(drive.beliefs);
  if (!bytes) return unusable(bytes.error());
  const auto soils = api::json::read_soil_file(*bytes);
  if (!soils) {
    Error error = soils.error();
    error.detail = fmt::format("{}: {}", drive.beliefs, error.detail);
    for (Fault& fault : error.faults) fault.pointer = fmt::format("{}#{}", drive.beliefs, fault.pointer);
    return unusable(std::move(error));
  }
  w.key("beliefs").begin_array();
  for (const sim::SoilDistribution& soil : *soils) api::json::write_soil(w, soil);
  w.end_array();
  return {};
}

// The table of the sky that --sky names, into a departure that is open.
Result<void> write_sky_option(Writer& w, const DriveOptions& drive) {
  if (!drive.sky_of_kernels.empty()) {
    api::json::write_sky(w.key("sky"), drive.sky_of_kernels);
  } else if (!drive.sky.empty() && std::none_of(drive.sky.begin(), drive.sky.end(), is_kernel_file)) {
    if (drive.sky.size() > 1)
      return fail(ErrorCode::kInvalidRequest,
                  fmt::format("--sky has {} files, of which none is a SPICE kernel: a table is one file",
                              drive.sky.size()));
    const std::string& file = drive.sky.front();
    const auto bytes = read_request(file);
    if (!bytes) return fail(bytes.error());
    const auto moments = api::json::parse(*bytes);
    if (!moments) {
      Error error = moments.error();
      error.detail = fmt::format("--sky {} is no list of moments in JSON, as departure.sky of a request: {}",
                                 file, error.detail);
      return fail(std::move(error));
    }
    write_value(w.key("sky"), *moments);
  }
  return {};
}

// "air.coldest_c=-80" is a key of the departure's air, "min_sun_deg=5" one of its own.
void write_day(Writer& w, const std::vector<std::string>& day) {
  constexpr std::string_view kAir = "air.";
  bool has_air = false;
  for (const std::string& setting : day)
    if (setting.starts_with(kAir))
      has_air = true;
    else
      write_setting(w, setting);
  if (!has_air) return;
  w.key("air").begin_object();
  for (const std::string& setting : day)
    if (setting.starts_with(kAir)) write_setting(w, setting.substr(kAir.size()));
  w.end_object();
}

// "FROM..TO" as two texts, whatever they are; one text for both.
std::pair<std::string, std::string> ends_of(const std::string& text) {
  const std::size_t dots = text.find("..");
  return {text.substr(0, dots), text.substr(dots == std::string::npos ? 0 : dots + 2)};
}

// Times that are none are left to the request's reader, which names them beside what else is wrong.
Result<void> write_departure(Writer& w, const DriveOptions& drive) {
  if (!drive.depart) return {};
  const auto [from, to] = ends_of(*drive.depart);
  w.key("departure").begin_object().text("from", from).text("to", to);
  write_day(w, drive.day);
  if (auto written = write_sky_option(w, drive); !written) return written;
  w.end_object();
  return {};
}

}  // namespace

void write_place(Writer& w, const PlaceOption& place) {
  w.begin_object().exact("x_m", place.x_m).exact("y_m", place.y_m);
  if (place.yaw_deg) w.exact("yaw_deg", *place.yaw_deg);
  w.end_object();
}

Result<TimeSpan> time_span(std::string_view option, const std::string& text) {
  const auto [from, to] = ends_of(text);
  TimeSpan span{from, to};
  for (const auto& [time, into] : {std::pair{&span.from, &span.from_ms}, {&span.to, &span.to_ms}}) {
    const auto at = utc_of_text(*time);
    if (!at) {
      const std::string why =
          fmt::format("{} is no time; give FROM..TO, such as 2016-03-22T09:00:00Z..2016-03-22T14:00:00Z",
                      in_quotes(*time));
      return fail(ErrorCode::kInvalidRequest, fmt::format("{} {}: {}", option, text, why),
                  {{std::string(option), why}});
    }
    *into = *at;
  }
  return span;
}

std::function<Error(Error)> placed_on_command_line(const DriveOptions& drive) {
  return [drive](Error error) {
    for (Fault& fault : error.faults)
      if (!drive.day.empty() && fault.pointer == "/departure/air")
        fault.message += ": on the command line --day air.coldest_c=-80 --day air.warmest_c=-10";
    const auto times = drive.depart ? time_span("--depart", *drive.depart) : Result<TimeSpan>(TimeSpan());
    if (times) return error;
    // No sky was made of kernels for these times, and none is missing.
    const bool has_kernels = std::any_of(drive.sky.begin(), drive.sky.end(), is_kernel_file);
    const auto is_time = [&](const Fault& fault) {
      return fault.pointer == "/departure/from" || fault.pointer == "/departure/to" ||
             (has_kernels && fault.pointer == "/departure/sky");
    };
    const auto first = std::find_if(error.faults.begin(), error.faults.end(), is_time);
    if (first == error.faults.end()) return error;
    *first = {"--depart", times.error().faults.front().message};
    error.faults.erase(std::remove_if(first, error.faults.end(), is_time), error.faults.end());
    error.detail = api::summary_of(error.faults);
    return error;
  };
}

Result<void> write_drive(Writer& w, const DriveOptions& drive) {
  if (!drive.terrain.empty()) w.text("terrain", drive.terrain);
  if (!drive.rover.empty()) w.text("rover", drive.rover);
  if (!drive.limits.empty()) {
    w.key("limits").begin_object();
    for (const auto& [key, value] : drive.limits) w.exact(key, value);
    w.end_object();
  }
  write_given(w, "checks",
              {{"slip_check_every_m", drive.slip_check_every_m},
               {"embedding_slip", drive.embedding_slip},
               {"embedding_turns", drive.embedding_turns},
               {"embedding_sinkage_share", drive.embedding_sinkage_share}});
  write_given(w, "bars",
              {{"max_embedding", drive.max_embedding},
               {"max_immobilised", drive.max_immobilised},
               {"max_stop", drive.max_stop},
               {"no_go_stop", drive.no_go_stop}});
  if (!drive.effects.empty()) {
    w.key("effects").begin_array();
    for (const std::string& effect : drive.effects) write_effect(w, effect);
    w.end_array();
  }
  if (!drive.failed.empty()) {
    w.key("failed_wheels").begin_object();
    for (const std::string& failed : drive.failed) write_setting(w, failed);
    w.end_object();
  }
  if (auto written = write_files(w, drive); !written) return written;
  write_given(w, "relief",
              {{"elevation_error_m", drive.elevation_error_m},
               {"roughness_m", drive.roughness_m},
               {"rock_share", drive.rock_share}},
              drive.relief);
  if (!drive.unknown_soil.empty()) w.text("unknown_soil", drive.unknown_soil);
  if (drive.segment_m) w.exact("segment_m", *drive.segment_m);
  if (drive.confidence) w.exact("confidence", *drive.confidence);
  if (!drive.legend.empty()) w.text("legend", drive.legend);
  if (drive.as_of_sol) w.whole("as_of_sol", *drive.as_of_sol);
  if (drive.draws) w.whole("draws", *drive.draws);
  if (drive.seed) w.whole("seed", *drive.seed);
  if (drive.speed_m_s) w.exact("speed_m_s", *drive.speed_m_s);
  if (drive.motor_temp_c) w.exact("motor_temp_c", *drive.motor_temp_c);
  if (auto written = write_departure(w, drive); !written) return written;
  if (auto written = write_zone_options(w, "keep_out", drive.keep_out); !written) return written;
  return write_zone_options(w, "keep_in", drive.keep_in);
}

Result<std::string> read_request(const std::string& path) {
  const Input input(path);
  if (input.descriptor() < 0)
    return fail(ErrorCode::kUnreadableData,
                fmt::format("cannot open {}: {}", path, std::system_category().message(errno)));
  std::string text;
  std::array<char, 65536> piece{};
  constexpr int kLook_ms = 100;
  while (!given_up()) {
    // A read of a terminal or a pipe would go on through an interruption: it is begun when there is something
    // to read.
    pollfd waiting{input.descriptor(), POLLIN, 0};
    if (::poll(&waiting, 1, kLook_ms) <= 0) continue;
    const ssize_t count = ::read(input.descriptor(), piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0)
      return fail(ErrorCode::kUnreadableData,
                  fmt::format("cannot read {}: {}", path, std::system_category().message(errno)));
    if (count == 0) return text;
    text.append(piece.data(), static_cast<std::size_t>(count));
    if (text.size() > api::RequestLimits::kBodyBytes)
      return fail(ErrorCode::kPayloadTooLarge,
                  fmt::format("a request has at most {} bytes", api::RequestLimits::kBodyBytes));
  }
  return fail(ErrorCode::kCancelled, "the question was given up before it was read");
}

}  // namespace slipway::server
