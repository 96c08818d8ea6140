#include "planner/judge/fewer_routes.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "planner/problem/keep_out.h"
#include "planner/search/select_routes.h"

namespace slipway::planner {

std::string too_alike(const PlanProblem& problem, std::size_t candidates, std::size_t kept) {
  return fmt::format(
      "{} of {} candidates share more than {:.0f} % of their length, within {:.1f} m (the rover's width), "
      "with "
      "one of the routes given",
      candidates - kept, candidates, 100.0 * kMaxOverlap, problem.rover->body_width_m);
}

std::string left_out_as_no_go(std::size_t count, const std::string& reason) {
  if (count == 1) return fmt::format("1 more route is NO-GO: {}", reason);
  return fmt::format("{} more routes are NO-GO, the best of them because {}", count, reason);
}

std::string dropped_for_keep_outs(const PlanProblem& problem, const std::vector<Pose2>& poses) {
  return fmt::format("{} that a planner found {} dropped: the rover's body would {}{} at ({:.2f}, {:.2f})",
                     poses.size() == 1 ? "a route" : fmt::format("{} routes", poses.size()),
                     poses.size() == 1 ? "is" : "are", trespass_in_words(problem),
                     poses.size() == 1 ? "" : ", the first", poses.front().x_m, poses.front().y_m);
}

std::vector<std::string> unpredicted_in_words(const std::vector<Error>& errors, std::size_t candidates) {
  std::vector<std::string> words;
  const auto without_ground = std::count_if(errors.begin(), errors.end(),
                                            [](const Error& e) { return e.code == ErrorCode::kNoData; });
  if (without_ground > 0)
    words.push_back(
        fmt::format("{} of {} candidates lead a wheel over missing elevation", without_ground, candidates));
  for (const Error& error : errors) {
    if (error.code == ErrorCode::kNoData) continue;
    std::string line = "a candidate could not be predicted: " + error.detail;
    if (std::find(words.begin(), words.end(), line) == words.end()) words.push_back(std::move(line));
  }
  return words;
}

}  // namespace slipway::planner
