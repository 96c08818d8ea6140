#include "planner/problem/verdict.h"

#include <algorithm>
#include <utility>

namespace slipway::planner {

std::string_view describe(Verdict verdict) {
  switch (verdict) {
    case Verdict::kGo:
      return "go";
    case Verdict::kNoGo:
      return "no_go";
    case Verdict::kUnknown:
      break;
  }
  return "unknown";
}

std::string_view verdict_words(std::string_view name) {
  if (name == describe(Verdict::kGo)) return "GO";
  return name == describe(Verdict::kNoGo) ? "NO-GO" : "UNKNOWN";
}

int severity(Verdict verdict) {
  if (verdict == Verdict::kNoGo) return 2;
  return verdict == Verdict::kUnknown ? 1 : 0;
}

void add_rule(JudgedRule rule, DriveVerdict& verdict) {
  const auto place = std::find_if(verdict.rules.begin(), verdict.rules.end(), [&](const JudgedRule& other) {
    return severity(other.verdict) < severity(rule.verdict);
  });
  verdict.rules.insert(place, std::move(rule));
  verdict.verdict = verdict.rules.front().verdict;
}

std::string_view describe(Advice::Kind kind) {
  switch (kind) {
    case Advice::Kind::kShorterDrive:
      return "shorter_drive";
    case Advice::Kind::kOtherRoute:
      return "other_route";
    case Advice::Kind::kScoutDrive:
      break;
  }
  return "scout_drive";
}

}  // namespace slipway::planner
