#pragma once

#include <filesystem>

#include "api/jobs/sqlite_connection.h"
#include "api/jobs/sqlite_job_store.h"

namespace slipway::api {

// Before a store is opened: a store whose marker file is there has not vanished. Throws SqliteFailure with
// the file and what to do. A store in memory, whose path is empty, has none.
void check_marker(const std::filesystem::path& store);

// Makes the tables of an empty store; checks those of another, and brings an older one to this version after
// it was copied beside itself. Then leaves a marker beside the store. Throws SqliteFailure with the file and
// what to do where it is damaged, something else or of a newer program.
void settle_schema(SqliteConnection& connection, const std::filesystem::path& store, StoreCheck how_far);

}  // namespace slipway::api
