#include "api/json/text_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "api/json/json_value.h"

namespace slipway::api::json {
namespace {

// Walks over the bytes of a JSON text that is known to be one.
class Walker {
 public:
  explicit Walker(std::string_view bytes) : bytes_(bytes) { skip_space(); }

  std::size_t at() const { return at_; }

  // To the value under `step`, as child_pointer() writes it; false where there is none.
  bool enter(std::string_view step) {
    if (at_ >= bytes_.size() || (bytes_[at_] != '{' && bytes_[at_] != '[')) return false;
    const bool object = bytes_[at_] == '{';
    const char end = object ? '}' : ']';
    ++at_;
    skip_space();
    for (std::size_t index = 0; at_ < bytes_.size() && bytes_[at_] != end; ++index) {
      std::string name = child_pointer("", index);
      if (object) {
        const std::size_t begin = at_ + 1;
        skip_string();
        name = child_pointer("", bytes_.substr(begin, at_ - 1 - begin));
        skip_space();
        ++at_;  // the colon
        skip_space();
      }
      if (std::string_view(name).substr(1) == step) return true;
      skip_value();
      skip_space();
      if (at_ < bytes_.size() && bytes_[at_] == ',') ++at_;
      skip_space();
    }
    return false;
  }

 private:
  void skip_space() { at_ = std::min(bytes_.find_first_not_of(" \t\r\n", at_), bytes_.size()); }

  void skip_string() {
    for (++at_; at_ < bytes_.size() && bytes_[at_] != '"'; ++at_)
      if (bytes_[at_] == '\\') ++at_;
    ++at_;
  }

  void skip_value() {
    int depth = 0;
    while (at_ < bytes_.size()) {
      const char c = bytes_[at_];
      if (depth == 0 && (c == ',' || c == '}' || c == ']')) return;
      if (c == '"') {
        skip_string();
        continue;
      }
      if (c == '{' || c == '[') ++depth;
      if (c == '}' || c == ']') --depth;
      ++at_;
    }
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
};

}  // namespace

TextPlace place_of(std::string_view bytes, std::string_view pointer) {
  Walker walker(bytes);
  std::size_t at = walker.at();
  while (!pointer.empty()) {
    const std::size_t end = std::min(pointer.find('/', 1), pointer.size());
    if (!walker.enter(pointer.substr(1, end - 1))) break;
    at = walker.at();
    pointer.remove_prefix(end);
  }
  const std::string_view before = bytes.substr(0, at);
  const std::size_t newline = before.rfind('\n');
  return {1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')),
          newline == std::string_view::npos ? at + 1 : at - newline};
}

std::string with_place(std::string_view file, std::string_view bytes, std::string_view pointer,
                       std::string_view message) {
  const TextPlace place = place_of(bytes, pointer);
  return fmt::format("{}, line {}, column {} ({}): {}", file, place.line, place.column,
                     pointer.empty() ? "all of it" : pointer, message);
}

}  // namespace slipway::api::json
