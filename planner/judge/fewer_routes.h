#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/pose.h"
#include "core/result.h"
#include "planner/problem/problem.h"

// Why a plan has fewer routes than were asked for, in words.
namespace slipway::planner {

// Only `kept` of so many candidates differ enough.
std::string too_alike(const PlanProblem& problem, std::size_t candidates, std::size_t kept);

// So many routes are NO-GO, the best of them for this reason.
std::string left_out_as_no_go(std::size_t count, const std::string& reason);

// Routes that trespass on an area, at these poses, at least one.
std::string dropped_for_keep_outs(const PlanProblem& problem, const std::vector<Pose2>& poses);

// What kept candidates from being predicted: missing elevation is counted, any other error is given as it is,
// once.
std::vector<std::string> unpredicted_in_words(const std::vector<Error>& errors, std::size_t candidates);

}  // namespace slipway::planner
