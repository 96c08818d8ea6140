#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "core/result.h"
#include "research/validation/report/report.h"

namespace slipway::validation {

// One row per comparison; a new comparison is a file and a row.
struct Comparison {
  std::string_view name;     // "ding_2011", on the command line and in the name of its plot
  std::string_view summary;  // one line for people
  std::string_view source;   // who measured or computed it, in short
  Result<Report> (*run)(const std::filesystem::path& data);
};

// The explicit list, in the order of docs/validation.md.
std::span<const Comparison> comparison_catalogue();

// nullptr where there is none of this name.
const Comparison* find_comparison(std::string_view name);

}  // namespace slipway::validation
