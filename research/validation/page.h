#pragma once

#include <filesystem>
#include <string>

#include "core/result.h"

namespace slipway::validation {

// The part of docs/validation.md that is printed, between two marker lines.
inline constexpr std::string_view kPageBegin = "<!-- begin: printed by slipway validate -->\n";
inline constexpr std::string_view kPageEnd = "<!-- end: printed by slipway validate -->\n";

// Whether the page holds exactly these bytes between its markers. Errors: unreadable_data where the file or
// its markers are missing.
Result<bool> page_holds(const std::filesystem::path& page, const std::string& printed);

// Puts these bytes between the markers and leaves the rest of the page unchanged. Errors: as above, and
// storage where the page cannot be written.
Result<void> write_page(const std::filesystem::path& page, const std::string& printed);

}  // namespace slipway::validation
