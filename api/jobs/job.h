#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace slipway::api {

// accepted -> running -> successful | failed; accepted | running -> dismissed. A job whose worker died goes
// back from running to accepted. What has ended never changes.
enum class JobState { kAccepted, kRunning, kSuccessful, kFailed, kDismissed };

// "accepted", "running", "successful", "failed", "dismissed".
std::string_view describe(JobState state);
std::span<const std::string_view> job_state_names();
std::optional<JobState> job_state(std::string_view name);
bool has_ended(JobState state);

// Urgencies go from 0, which begins first, to 7 [RFC 9218, 4.1].
inline constexpr int kUsualUrgency = 3;
inline constexpr int kLeastUrgency = 7;

// How far the parts of a job are.
struct JobParts {
  int count = 0;       // 0: the job is done in one go
  int ended = 0;       // of them, in whatever way
  int failed = 0;      // of those that ended: without an answer
  double cpu_s = 0.0;  // processor time of those that ended
};

// What is known of a job, without the bytes of its request and outcome.
struct Job {
  std::string id;    // 32 hexadecimal digits: 128 random bits, so that nobody guesses another's job
  std::string kind;  // the name of a JobKind: "plan"
  JobState state = JobState::kAccepted;
  std::string stage;             // what the work is at, a short noun phrase
  double progress = 0.0;         // of the whole, in [0, 1]
  std::int64_t version = 1;      // grows with every change: the ETag
  int attempt = 0;               // how often it was claimed
  int deaths = 0;                // how often a worker left it without handing it back
  std::string last_death = {};   // why the last of them did, in words for a person; empty: none has
  std::string owner = {};        // who asked for it
  std::string best_so_far = {};  // what this attempt has found until now, a JSON object; empty: nothing
  int urgency = kUsualUrgency;   // which of those that wait begins first
  std::int64_t created_ms = 0;   // since 1970, as the times below
  std::optional<std::int64_t> started_ms;
  std::optional<std::int64_t> ended_ms;
  double cpu_s = 0.0;      // processor time of the attempt that ended it
  std::string whole = {};  // the job that this one is a part of; empty: of none
  int part = 0;            // which part of it, from 0 on
  JobParts parts = {};     // of which this one consists
};

// 128 bits from the machine's entropy.
std::string new_job_id();
bool is_job_id(std::string_view text);

}  // namespace slipway::api
