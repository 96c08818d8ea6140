#include "server/cli/report_output.h"

#include <filesystem>
#include <system_error>

#include "api/files/whole_file.h"

namespace slipway::server {

namespace fs = std::filesystem;

bool is_report_page(const std::string& path) {
  std::error_code error;
  return fs::path(path).extension() == ".html" && !fs::is_directory(path, error);
}

Result<void> make_room_for_report(const std::string& path) {
  if (!is_report_page(path)) return api::make_folder(path);
  const fs::path beside = fs::path(path).parent_path();
  return beside.empty() ? Result<void>() : api::make_folder(beside);
}

std::vector<OutputFile> report_output(const std::string& path, const api::ReportPage& report,
                                      const std::vector<api::NamedChart>& charts,
                                      std::string_view document_name, const std::string& document) {
  if (is_report_page(path)) return {{path, report.html()}};
  const fs::path folder(path);
  std::vector<OutputFile> files{{(folder / document_name).string(), document},
                                {(folder / "report.md").string(), report.markdown()},
                                {(folder / "report.html").string(), report.html()}};
  for (const api::NamedChart& chart : charts)
    files.push_back({(folder / (chart.name + ".svg")).string(), chart.svg});
  return files;
}

}  // namespace slipway::server
