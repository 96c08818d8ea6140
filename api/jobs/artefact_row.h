#pragma once

#include <cstddef>
#include <string_view>

namespace slipway::api {

// What stands in a row for a page that is in a folder of artefacts: this mark, the page's name, and how many
// bytes it has, in 16 decimal digits (rows of older programs: without them). A page that begins with the mark
// itself is kept in the folder too. Stores read the number to know what a job takes.
inline constexpr std::string_view kArtefactMark("\0slipway artefact\0", 18);
inline constexpr std::size_t kArtefactNameDigits = 64;
inline constexpr std::size_t kArtefactRowBytes = kArtefactMark.size() + kArtefactNameDigits + 16;

}  // namespace slipway::api
