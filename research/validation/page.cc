#include "research/validation/page.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

namespace slipway::validation {
namespace {

struct Page {
  std::string before, between, after;  // before ends and after begins with its marker
};

Result<Page> read_page(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return fail(ErrorCode::kUnreadableData, fmt::format("cannot open {}", path.string()));
  std::stringstream content;
  content << file.rdbuf();
  const std::string text = content.str();
  const std::size_t begin = text.find(kPageBegin);
  const std::size_t end = begin == std::string::npos ? begin : text.find(kPageEnd, begin);
  if (end == std::string::npos)
    return fail(ErrorCode::kUnreadableData, fmt::format("{} lacks its markers", path.string()));
  const std::size_t middle = begin + kPageBegin.size();
  return Page{text.substr(0, middle), text.substr(middle, end - middle), text.substr(end)};
}

}  // namespace

Result<bool> page_holds(const std::filesystem::path& path, const std::string& printed) {
  return read_page(path).map([&](const Page& page) { return page.between == printed; });
}

Result<void> write_page(const std::filesystem::path& path, const std::string& printed) {
  const auto page = read_page(path);
  if (!page) return fail(page.error());
  std::ofstream file(path);
  file << page->before << printed << page->after;
  file.close();
  if (!file) return fail(ErrorCode::kUnwritableFile, fmt::format("cannot write {}", path.string()));
  return {};
}

}  // namespace slipway::validation
