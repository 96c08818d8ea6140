#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace slipway::server {

// The origin form ("/path?query") of a request's target; "*" only with OPTIONS. Empty when the target is
// neither, or when its path or query does not decode to UTF-8 without control characters. Such text would
// have to be escaped by everyone after us (logs, problem documents, file names): it is refused here, once.
std::optional<std::string> checked_target(std::string_view method, std::string_view target);

// The host and port that a target in absolute form ("http://host:80/path") is at; nothing in another form.
std::optional<std::string_view> authority_in(std::string_view target);

// "%41" becomes "A". Empty when a percent sign is not followed by two hexadecimal digits.
std::optional<std::string> percent_decoded(std::string_view text);

bool is_printable_utf8(std::string_view text);

}  // namespace slipway::server
