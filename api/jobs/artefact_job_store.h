#pragma once

#include <cstddef>
#include <memory>

#include "api/jobs/job_store.h"
#include "api/uploads/artefact_folder.h"

namespace slipway::api {

// Pages of this size and more are kept in the folder.
inline constexpr std::size_t kMinArtefactBytes = std::size_t{64} << 10U;

// The store, with the large pages of its series (the pieces of rasters, tables of stations) in a folder that
// its machines share: the rows hold their names. A page is in the folder before its row is in the store, so a
// row never names what is not there. Pages that no job of the last Retention::most_age_ms and a day can name
// are removed when ended jobs are forgotten.
std::unique_ptr<JobStore> with_artefacts(std::unique_ptr<JobStore> store,
                                         std::shared_ptr<ArtefactFolder> folder);

}  // namespace slipway::api
