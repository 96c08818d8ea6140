#pragma once

#include <span>
#include <string_view>

namespace slipway::server {

// A file of dashboard/dist, as it was when this program was built.
struct DashboardFile {
  std::string_view name;  // "index.html", "assets/index-Cv3D0l1a.js"
  std::string_view bytes;
};
std::span<const DashboardFile> dashboard_files();

}  // namespace slipway::server
