#pragma once

#include <string>
#include <vector>

#include "api/files/campaign/imported_wheels.h"

namespace slipway::api {

// What drives that turn show of wheels in another order than the mapping's, of steering angles and of
// headings of the other sense. Rates must be of the right sense already.
std::vector<std::string> order_warnings(const ImportedWheels& wheels);

}  // namespace slipway::api
