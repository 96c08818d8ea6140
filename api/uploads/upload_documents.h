#pragma once

#include <string>
#include <vector>

#include "api/uploads/upload_folder.h"

namespace slipway::api::json {

std::string write_upload(const Upload& upload);
std::string write_uploads(const std::vector<Upload>& uploads);

}  // namespace slipway::api::json
