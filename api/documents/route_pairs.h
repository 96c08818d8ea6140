#pragma once

#include <array>
#include <vector>

#include "api/json/json_value.h"

namespace slipway::api::json {

// A route of an answer's document, which must outlive it.
struct AnsweredRoute {
  const JsonValue* figures = nullptr;     // of a plan, its row of the summary; else the document's summary
  const JsonValue* properties = nullptr;  // of its feature
  std::vector<std::array<double, 2>> line;
};

// The routes of a "plan/1" document by rank, or the one drive of a "check/1" or "prediction/1".
std::vector<AnsweredRoute> routes_of(const JsonValue& document);

// Two routes with the larger of the mean distances of one's points to the other, in metres; or one alone.
struct RoutePair {
  const AnsweredRoute* a = nullptr;
  const AnsweredRoute* b = nullptr;
  double apart_m = 0.0;
};

// How far two routes are apart.
double apart_m(const AnsweredRoute& a, const AnsweredRoute& b);

// The two that are nearest to each other first, and so on; then in the order of a, and last those that are
// left.
std::vector<RoutePair> pairs_of(const std::vector<AnsweredRoute>& a, const std::vector<AnsweredRoute>& b);

}  // namespace slipway::api::json
