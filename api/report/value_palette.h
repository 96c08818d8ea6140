#pragma once

#include <array>

namespace slipway::api {

// Colours of five classes, the best first: blue to dark red, apart by lightness and hue for colour-blind eyes
// too [ColorBrewer RdYlBu]. The dashboard has the same.
inline constexpr std::array kValuePalette{"#2c7bb6", "#abd9e9", "#fdae61", "#d7191c", "#67001f"};

}  // namespace slipway::api
