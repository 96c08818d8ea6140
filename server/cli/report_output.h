#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/chart/chart.h"
#include "api/chart/report_page.h"
#include "core/result.h"
#include "server/cli/command_parts.h"

namespace slipway::server {

// What --report names: one HTML page where the name ends in ".html" and is no folder, else a folder.
bool is_report_page(const std::string& path);

// Makes the folder of a report, or that in which its page is to lie. Errors: unwritable_file.
Result<void> make_room_for_report(const std::string& path);

// The page alone, or report.html, report.md, every picture and the document under its name in the folder.
std::vector<OutputFile> report_output(const std::string& path, const api::ReportPage& report,
                                      const std::vector<api::NamedChart>& charts,
                                      std::string_view document_name, const std::string& document);

}  // namespace slipway::server
