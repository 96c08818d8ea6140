#include "server/routes/query.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include "api/json/faults.h"

namespace slipway::server {
namespace {

template <class Number>
bool read(const std::string& text, Number& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

Query::Query(const HttpRequest& request, std::vector<std::string> known) : request_(request) {
  std::vector<std::string> seen;
  for (const auto& [name, value] : request.query) {
    if (std::find(seen.begin(), seen.end(), name) != seen.end()) continue;  // said of the first
    seen.push_back(name);
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      faults_.push_back({"/" + name, unknown_name("query parameter", name, known)});
    } else if (std::count_if(request.query.begin(), request.query.end(),
                             [&n = name](const auto& entry) { return entry.first == n; }) > 1) {
      faults_.push_back({"/" + name, fmt::format("{} is given more than once", name)});
    }
  }
}

std::string Query::required_text(const std::string& name) {
  auto text = request_.query_value(name);
  if (!text || text->empty()) faults_.push_back({"/" + name, fmt::format("{} is missing", name)});
  return std::move(text).value_or("");
}

double Query::required_number(const std::string& name) {
  const auto text = request_.query_value(name);
  double value = 0.0;
  if (!text) {
    faults_.push_back({"/" + name, fmt::format("{} is missing", name)});
  } else if (!read(*text, value) || !std::isfinite(value)) {
    faults_.push_back({"/" + name, fmt::format("{} = {}, must be a number", name, in_quotes(*text))});
  }
  return value;
}

std::string Query::text(const std::string& name) const {
  return request_.query_value(name).value_or("");
}

std::vector<double> Query::required_numbers(const std::string& name) {
  const auto rows = required_rows(name, false);
  return rows.empty() ? std::vector<double>() : rows.front();
}

std::vector<std::vector<double>> Query::required_rows(const std::string& name, bool many) {
  const auto text = request_.query_value(name);
  if (!text) {
    fault(name, fmt::format("{} is missing", name));
    return {};
  }
  std::vector<std::vector<double>> rows(1);
  std::size_t values = 0;
  for (std::size_t from = 0; from <= text->size();) {
    const std::size_t end = std::min(text->find_first_of(many ? ",;" : ",", from), text->size());
    double value = 0.0;
    ++values;
    if (!read(text->substr(from, end - from), value) || !std::isfinite(value)) {
      fault(name, fmt::format("value {} of {} is {}, must be a number", values, name,
                              in_quotes(text->substr(from, end - from))));
      return {};
    }
    rows.back().push_back(value);
    if (end < text->size() && (*text)[end] == ';') rows.emplace_back();
    from = end + 1;
  }
  return rows;
}

void Query::fault(const std::string& name, std::string message) {
  faults_.push_back({"/" + name, std::move(message)});
}

std::size_t Query::count(const std::string& name, std::size_t initial, std::size_t most) {
  const auto text = request_.query_value(name);
  std::size_t value = initial;
  if (text && (!read(*text, value) || value < 1 || value > most)) {
    faults_.push_back({"/" + name, fmt::format("{} = {}, must be a whole number in [1, {}]", name,
                                               in_quotes(*text), most)});
  }
  return value;
}

std::optional<Error> Query::error() const {
  if (faults_.empty()) return std::nullopt;
  return Error{ErrorCode::kInvalidRequest, api::summary_of(faults_), faults_};
}

}  // namespace slipway::server
