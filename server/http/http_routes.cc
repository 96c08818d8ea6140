#include "server/http/http_routes.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "server/http/http_target.h"

namespace slipway::server {
namespace {

bool is_parameter(std::string_view segment) {
  return segment.size() > 2 && segment.front() == '{' && segment.back() == '}';
}

std::vector<std::string> segments_of(std::string_view path) {
  std::vector<std::string> out;
  while (!path.empty()) {
    path.remove_prefix(1);  // the slash
    const std::size_t end = std::min(path.find('/'), path.size());
    out.emplace_back(path.substr(0, end));
    path.remove_prefix(end);
  }
  return out;
}

// True for the one to be tried first; patterns that match the same addresses are equal.
bool more_literal(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
                                      [](const std::string& x, const std::string& y) {
                                        if (is_parameter(x) || is_parameter(y)) {
                                          return !is_parameter(x) && is_parameter(y);
                                        }
                                        return x < y;
                                      });
}

bool matches(const std::vector<std::string>& pattern, const std::vector<std::string>& path) {
  return std::equal(pattern.begin(), pattern.end(), path.begin(), path.end(),
                    [](const std::string& expected, const std::string& given) {
                      return is_parameter(expected) ? !given.empty() : expected == given;
                    });
}

void check(const Route& route) {
  const auto refuse = [&](std::string_view why) {
    throw std::invalid_argument(fmt::format("route {} {}: {}", route.method, route.pattern, why));
  };
  if (route.method.empty()) refuse("a method is needed");
  if (!route.handle) refuse("a handler is needed");
  if (route.pattern.empty() || route.pattern.front() != '/') refuse("a pattern begins with a slash");
  for (const std::string& segment : segments_of(route.pattern)) {
    if (!is_parameter(segment) && segment.find_first_of("{}?#%") != std::string::npos) {
      refuse("a segment is literal text or one {name}");
    }
  }
}

}  // namespace

RouteTable::RouteTable(std::vector<Route> routes) {
  for (Route& route : routes) {
    check(route);
    auto segments = segments_of(route.pattern);
    entries_.push_back({std::move(route), std::move(segments)});
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    if (more_literal(a.segments, b.segments)) return true;
    return !more_literal(b.segments, a.segments) && a.route.method < b.route.method;
  });
  for (std::size_t i = 1; i < entries_.size(); ++i) {
    const Entry& a = entries_[i - 1];
    const Entry& b = entries_[i];
    if (a.route.method == b.route.method && !more_literal(a.segments, b.segments)) {
      throw std::invalid_argument(fmt::format("routes {} {} and {} match the same requests", a.route.method,
                                              a.route.pattern, b.route.pattern));
    }
  }
}

std::string RouteTable::allowed(const std::vector<const Entry*>& entries) const {
  std::set<std::string> methods{"OPTIONS"};
  for (const Entry* entry : entries) {
    methods.insert(entry->route.method);
    if (entry->route.method == "GET") methods.insert("HEAD");
  }
  return fmt::format("{}", fmt::join(methods, ", "));
}

const Route* RouteTable::find(std::string_view method, std::string_view raw_path) const {
  const std::vector<std::string> path = segments_of(raw_path);
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.route.method == method && matches(entry.segments, path);
  });
  return found == entries_.end() ? nullptr : &found->route;
}

HttpResponse RouteTable::answer(
    HttpRequest& request,
    const std::function<HttpResponse(const Error&, const HttpRequest*)>& problem) const {
  std::vector<std::string> path = segments_of(request.raw_path);
  for (std::string& segment : path) segment = percent_decoded(segment).value_or(segment);
  std::vector<const Entry*> known;
  for (const Entry& entry : entries_) {
    if (request.raw_path == "*" || matches(entry.segments, path)) known.push_back(&entry);
  }
  if (known.empty()) {
    return problem({ErrorCode::kNotFound, fmt::format("there is nothing at {}", request.path), {}}, &request);
  }
  const auto with_method = [&](std::string_view method) {
    return std::find_if(known.begin(), known.end(),
                        [&](const Entry* e) { return e->route.method == method; });
  };
  auto found = with_method(request.method);
  if (found == known.end() && request.method == "HEAD") found = with_method("GET");
  if (found != known.end() && request.raw_path != "*") {
    const auto& segments = (*found)->segments;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      if (!is_parameter(segments[i])) continue;
      request.parameters.emplace_back(segments[i].substr(1, segments[i].size() - 2), path[i]);
    }
    request.route = (*found)->route.pattern;
    return (*found)->route.handle(request);
  }
  HttpResponse response;
  if (request.method == "OPTIONS") {
    response.status = 204;
  } else {
    response = problem({ErrorCode::kMethodNotAllowed,
                        fmt::format("{} is not allowed at {}", request.method, request.path),
                        {}},
                       &request);
  }
  response.headers.emplace_back("Allow", allowed(known));
  return response;
}

}  // namespace slipway::server
