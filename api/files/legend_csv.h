#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "dem/soil_map.h"

namespace slipway::api {

struct LegendTable {
  std::vector<dem::SoilClass> classes;
  std::vector<std::string> notes;  // what was found out about the text, see TextTable::notes()
};

// Reads a legend value,label,soil[,rock_share] as read_text_table() reads a table; polygons need no value. An
// empty soil, or a word for none, is unknown ground. Values may be written as 1.0. Errors: unreadable_data;
// faults name the line and the column: "legend.csv, line 3, column 1 (value)".
Result<LegendTable> read_legend_table(std::string_view text, std::string_view file, bool polygons);

}  // namespace slipway::api
