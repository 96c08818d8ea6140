#include "api/jobs/job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <random>

namespace slipway::api {
namespace {

constexpr std::array<std::string_view, 5> kStateNames{"accepted", "running", "successful", "failed",
                                                      "dismissed"};
constexpr std::size_t kIdDigits = 32;

}  // namespace

std::string_view describe(JobState state) {
  return kStateNames.at(static_cast<std::size_t>(state));
}

std::span<const std::string_view> job_state_names() {
  return kStateNames;
}

std::optional<JobState> job_state(std::string_view name) {
  const auto found = std::find(kStateNames.begin(), kStateNames.end(), name);
  if (found == kStateNames.end()) return std::nullopt;
  return static_cast<JobState>(found - kStateNames.begin());
}

bool has_ended(JobState state) {
  return state != JobState::kAccepted && state != JobState::kRunning;
}

std::string new_job_id() {
  std::random_device entropy;  // getrandom(2) here; one per call, as it is not thread-safe
  std::string id;
  while (id.size() < kIdDigits) id += fmt::format("{:08x}", entropy());
  return id;
}

bool is_job_id(std::string_view text) {
  return text.size() == kIdDigits && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

}  // namespace slipway::api
