#include "api/jobs/job_digest.h"

#include <fmt/format.h>

#include <initializer_list>

#include "core/sha256.h"

namespace slipway::api {
namespace {

// With the length of each part before it, so that only the same parts have the same digest.
std::string digest_of_parts(std::initializer_list<std::string_view> parts) {
  Sha256 hash;
  for (const std::string_view part : parts) {
    hash.add(fmt::format("{}:", part.size()));
    hash.add(part);
  }
  return hash.digest();
}

}  // namespace

std::string request_digest(std::string_view id, std::string_view kind, std::string_view request) {
  return digest_of_parts({id, kind, request});
}

std::string outcome_digest(std::string_view id, std::string_view state, std::string_view outcome) {
  return digest_of_parts({id, state, outcome});
}

std::string end_digest(const Job& job, std::string_view request_sha256, std::string_view outcome_sha256) {
  const auto text = [](std::optional<std::int64_t> ms) { return ms ? fmt::format("{}", *ms) : ""; };
  return digest_of_parts({job.id, job.kind, job.owner, describe(job.state), fmt::format("{}", job.attempt),
                          text(job.created_ms), text(job.started_ms), text(job.ended_ms), job.whole,
                          fmt::format("{}", job.part), request_sha256, outcome_sha256});
}

std::string altered_end(std::string_view id) {
  return fmt::format("what is stored of job {} is not how it ended: ask again for what it was asked", id);
}

std::string series_digest(std::string_view id, std::int64_t page, std::string_view bytes) {
  return digest_of_parts({id, fmt::format("series {}", page), bytes});
}

}  // namespace slipway::api
