#pragma once

#include <cstddef>
#include <string_view>

namespace slipway::api::json {

// Where in a text something stands, from 1; columns in bytes.
struct TextPlace {
  std::size_t line = 1, column = 1;
};

// Where the value of a JSON pointer begins in the bytes of a document that has been parsed; of one that is
// not there, what would hold it.
TextPlace place_of(std::string_view bytes, std::string_view pointer);

}  // namespace slipway::api::json
