#include "server/request_headers.h"

#include <charconv>
#include <string>
#include <system_error>

namespace slipway::server {
namespace {

// Calls visit(item) for every item of a header's comma-separated list, over all its lines, without blanks
// around.
template <class Visit>
void for_each_item(const HttpRequest& request, std::string_view header, const Visit& visit) {
  for (const auto& [name, value] : request.headers) {
    if (!equal_ignoring_case(name, header)) continue;
    std::string_view rest = value;
    while (!rest.empty()) {
      const std::size_t comma = rest.find(',');
      std::string_view item = rest.substr(0, comma);
      rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
      const std::size_t first = item.find_first_not_of(" \t");
      if (first == std::string_view::npos) continue;
      visit(item.substr(first, item.find_last_not_of(" \t") - first + 1));
    }
  }
}

}  // namespace

bool accepts(const HttpRequest& request, std::string_view type) {
  bool wanted = false;
  for_each_item(request, "Accept", [&](std::string_view item) {
    wanted = wanted || equal_ignoring_case(item.substr(0, item.find(';')), type);
  });
  return wanted;
}

bool is_known_to_client(const HttpRequest& request, std::string_view tag) {
  bool known = false;
  for_each_item(request, "If-None-Match", [&](std::string_view item) {
    if (item.starts_with("W/")) item.remove_prefix(2);
    known = known || item == "*" || item == tag;
  });
  return known;
}

Preferences preferences_of(const HttpRequest& request) {
  Preferences preferences;
  for_each_item(request, "Prefer", [&](std::string_view item) {
    item = item.substr(0, item.find(';'));  // parameters of a preference: none of ours has any
    item = item.substr(0, item.find_last_not_of(" \t") + 1);
    if (equal_ignoring_case(item, "respond-async")) preferences.respond_async = true;
    constexpr std::string_view kWait = "wait=";
    if (preferences.wait || item.size() <= kWait.size() ||
        !equal_ignoring_case(item.substr(0, kWait.size()), kWait)) {
      return;
    }
    item.remove_prefix(kWait.size());
    if (item.size() > 2 && item.front() == '"' && item.back() == '"') item = item.substr(1, item.size() - 2);
    int value = 0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), value);
    if (error == std::errc() && end == item.data() + item.size() && value >= 0)
      preferences.wait = std::chrono::seconds(value);
  });
  return preferences;
}

}  // namespace slipway::server
