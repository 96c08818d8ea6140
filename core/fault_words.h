#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Words that the faults of every reader share.
namespace slipway {

// Text from outside as a message shows it: in quotes and shortened where it is long, never within a UTF-8
// character.
std::string in_quotes(std::string_view text);

// The name among `known` that `name` was probably meant to be; empty where none is near.
std::optional<std::string> nearest(std::string_view name, const std::vector<std::string>& known);

// "unknown rover \"mer\"; did you mean \"mer-class\"? known: fido-class, mer-class"
std::string unknown_name(std::string_view kind, std::string_view name, const std::vector<std::string>& known);

}  // namespace slipway
