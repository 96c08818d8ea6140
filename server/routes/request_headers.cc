#include "server/routes/request_headers.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <system_error>

namespace slipway::server {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

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
      item = trimmed(item);
      if (!item.empty()) visit(item);
    }
  }
}

// Of "; level=1; q=0.0": a weight of zero means that this is just what is not wanted [RFC 9110, 12.4.2].
bool has_weight_zero(std::string_view parameters) {
  while (!parameters.empty()) {
    parameters.remove_prefix(1);
    const std::string_view parameter = trimmed(parameters.substr(0, parameters.find(';')));
    parameters.remove_prefix(std::min(parameters.find(';'), parameters.size()));
    if (parameter.size() < 3 || !equal_ignoring_case(parameter.substr(0, 2), "q=")) continue;
    return parameter[2] == '0' && parameter.find_first_not_of("0.", 2) == std::string_view::npos;
  }
  return false;
}

// Whether the header's list names it, not with a weight of zero.
bool names(const HttpRequest& request, std::string_view header, std::string_view wanted_name) {
  bool wanted = false;
  for_each_item(request, header, [&](std::string_view item) {
    const std::string_view name = trimmed(item.substr(0, item.find(';')));
    if (equal_ignoring_case(name, wanted_name))
      wanted = !has_weight_zero(item.substr(std::min(item.find(';'), item.size())));
  });
  return wanted;
}

}  // namespace

bool accepts(const HttpRequest& request, std::string_view type) {
  return names(request, "Accept", type);
}

bool accepts_encoding(const HttpRequest& request, std::string_view coding) {
  return names(request, "Accept-Encoding", coding);
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

Result<api::Submission> submission_of(const HttpRequest& request) {
  api::Submission submission{.owner = request.principal.empty() ? request.remote_address : request.principal};
  for_each_item(request, "Priority", [&](std::string_view item) {
    if (item.size() == 3 && item.starts_with("u=") && item[2] >= '0' && item[2] <= '0' + api::kLeastUrgency)
      submission.urgency = item[2] - '0';
  });
  submission.key = request.header("Idempotency-Key");
  if (!submission.key) return submission;
  constexpr std::size_t kLongest = 255;
  const auto visible = [](char c) { return c > ' ' && c <= '~'; };
  if (submission.key->empty() || submission.key->size() > kLongest ||
      !std::all_of(submission.key->begin(), submission.key->end(), visible))
    return fail(ErrorCode::kInvalidRequest, "the request's headers are not as they must be",
                {{"/Idempotency-Key", "must be 1 to 255 visible ASCII characters without blanks"}});
  return submission;
}

}  // namespace slipway::server
