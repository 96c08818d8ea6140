#pragma once

#include <string>
#include <string_view>

#include "core/result.h"
#include "server/cli/inquiry/ask_options.h"

namespace slipway::server {

// Asks for a catalogue ("terrains", "rovers", "soils", "effects") and prints its document or its table. The
// exit status.
int print_catalogue(const AskOptions& ask, std::string_view kind,
                    Result<std::string> (*table)(std::string_view));
// Prints a document that was asked for already, or its table. The exit status.
int print_document(const AskOptions& ask, const Result<std::string>& document,
                   Result<std::string> (*table)(std::string_view));

}  // namespace slipway::server
