#pragma once

#include <filesystem>
#include <memory>

#include "api/jobs/job_store.h"

namespace slipway::api {

// How far a store is looked through when it is opened: the whole file takes a second for each gigabyte or so,
// and of several processes that share it one does it for all.
enum class StoreCheck { kWhole, kSchema };

// Jobs in an SQLite database, for one machine: what was acknowledged survives the process at once (kill -9),
// and accepted, ended and dismissed jobs survive a loss of power too. Progress and claims are not worth a
// wait for the disk: after a loss of power the job runs again. Appends that arrive together share one commit.
// Where the path is empty they are in this process's memory, and are lost with it.
Result<std::unique_ptr<JobStore>> open_sqlite_job_store(const std::filesystem::path& path,
                                                        StoreCheck how_far = StoreCheck::kWhole);

}  // namespace slipway::api
