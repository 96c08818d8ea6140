#pragma once

#include <optional>
#include <string_view>

#include "core/result.h"
#include "sky/orientation.h"

// How bodies stand, by NAIF's "PCK Required Reading": text kernels of constants.
namespace slipway::steps {

// Whether a text kernel has constants of bodies.
bool looks_like_constants(std::string_view text);

// How body `id` stands: its BODYnnn_POLE_RA, _POLE_DEC and _PM, and the terms BODYnnn_NUT_PREC_* of the
// angles that the barycentre of its planet has. Nothing where the kernel has no pole of the body. Errors:
// unreadable_data with the line or the name of what is wrong or missing.
Result<std::optional<sky::Orientation>> read_orientation(std::string_view text, std::string_view file,
                                                         int id);

}  // namespace slipway::steps
