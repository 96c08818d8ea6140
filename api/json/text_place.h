#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace slipway::api::json {

// A place in a text. Lines and columns count from 1, and columns are in bytes.
struct TextPlace {
  std::size_t line = 1, column = 1;
};

// The place where the value of a JSON pointer begins in the bytes of a valid document; where there is no such
// value, the place of the value that would hold it.
TextPlace place_of(std::string_view bytes, std::string_view pointer);

// The words of a fault at the pointer with its place in the file: "campaign.json, line 12, column 3 (/rover):
// ...".
std::string with_place(std::string_view file, std::string_view bytes, std::string_view pointer,
                       std::string_view message);

}  // namespace slipway::api::json
