#pragma once

#include <string_view>

namespace slipway::api {

// api/openapi.json, as it was when this program was built.
std::string_view openapi_document();

}  // namespace slipway::api
