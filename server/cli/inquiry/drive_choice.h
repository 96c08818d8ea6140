#pragma once

#include <string>
#include <vector>

#include "campaign/drive_table.h"
#include "core/result.h"

namespace slipway::server {

// The drives whose ids fit a pattern with * and ?; all where there is none. A pattern that fits none is a
// mistake: invalid_request at `pointer`.
Result<std::vector<campaign::TableDrive>> chosen_drives(const std::vector<campaign::TableDrive>& all,
                                                        const std::vector<std::string>& only,
                                                        const std::string& pointer);

}  // namespace slipway::server
