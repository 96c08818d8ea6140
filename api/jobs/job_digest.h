#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "api/jobs/job.h"

namespace slipway::api {

// SHA-256 digests that stand beside stored bytes. They take in what the bytes belong to, so that rows that
// were swapped are noticed like bytes that were altered.
std::string request_digest(std::string_view id, std::string_view kind, std::string_view request);
std::string outcome_digest(std::string_view id, std::string_view state, std::string_view outcome);
std::string series_digest(std::string_view id, std::int64_t page, std::string_view bytes);

// Of how a job ended: its id, kind, owner, state, attempt and times, what it is a part of, and the digests of
// its request and outcome (empty: it has none).
std::string end_digest(const Job& job, std::string_view request_sha256, std::string_view outcome_sha256);
// What is said of a job whose row has another digest.
std::string altered_end(std::string_view id);

}  // namespace slipway::api
