#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "api/json/writer.h"
#include "core/result.h"
#include "server/cli/inquiry/drive_options.h"

namespace slipway::server {

// "FROM..TO", or one time for both.
struct TimeSpan {
  std::string from, to;
  std::int64_t from_ms = 0, to_ms = 0;  // of UTC since 1970
};
// Errors: invalid_request with the option's name.
Result<TimeSpan> time_span(std::string_view option, const std::string& text);

// Of an error of a request that these options wrote: where its faults stand on the command line, with what is
// to be given there.
std::function<Error(Error)> placed_on_command_line(const DriveOptions& drive);

void write_place(api::json::Writer& w, const PlaceOption& place);

// The members that plans, predictions and checks have in common, of the object that is being written. Errors:
// those of write_zone_options().
Result<void> write_drive(api::json::Writer& w, const DriveOptions& drive);

// A whole request from a file, or from standard input where the path is "-"; an interruption ends the
// reading. Errors: unreadable_data; payload_too_large beyond what the service takes, of which no more is
// read; cancelled.
Result<std::string> read_request(const std::string& path);

}  // namespace slipway::server
