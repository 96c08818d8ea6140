#pragma once

#include <string>
#include <string_view>

#include "core/result.h"

namespace slipway::api::json {

// An error as a problem document (RFC 9457), with all its faults: {"type", "title", "status", "detail",
// "faults"}. It is bounded(), for whoever reads or keeps it.
std::string write_problem(const Error& error);

// Reads a document of write_problem again, so that a stored failure gives the same answer later. Other bytes
// give an internal error.
Error read_problem(std::string_view bytes);

}  // namespace slipway::api::json
