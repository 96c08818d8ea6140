#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace slipway::dem {

// Why a text from outside may not name a coordinate system; nothing where it may. It may be AUTHORITY:CODE or
// its URN, WKT, PROJJSON, or a PROJ string of keys whose values are numbers and words: nothing that makes a
// library open a file or an address. Whether there is such a system is not asked. The sentence follows the
// key's name: "must be ...".
std::optional<std::string> fault_of_crs_text(std::string_view text);

}  // namespace slipway::dem
