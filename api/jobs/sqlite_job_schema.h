#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "api/jobs/sqlite_connection.h"
#include "api/jobs/sqlite_job_store.h"

namespace slipway::api {

// Digests that stand beside stored bytes. They take in what the bytes belong to, so that rows that were
// swapped are noticed like bytes that were altered.
std::string request_digest(std::string_view id, std::string_view kind, std::string_view request);
std::string outcome_digest(std::string_view id, std::string_view state, std::string_view outcome);
std::string series_digest(std::string_view id, std::int64_t page, std::string_view bytes);

// Before a store is opened: a store whose marker file is there has not vanished. Throws SqliteFailure with
// the file and what to do.
void check_marker(const std::filesystem::path& store);

// Makes the tables of an empty store; checks those of another, and brings an older one to this version after
// it was copied beside itself. Then leaves a marker beside the store. Throws SqliteFailure with the file and
// what to do where it is damaged, something else or of a newer program.
void settle_schema(SqliteConnection& connection, const std::filesystem::path& store, StoreCheck how_far);

}  // namespace slipway::api
