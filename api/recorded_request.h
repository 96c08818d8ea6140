#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/service.h"
#include "api/uploads/upload_folder.h"
#include "core/result.h"

namespace slipway::api {

// A request as a job keeps it: behind a line that says who asked, and which version of each terrain it was
// checked on. One without that line is an older program's, or a part of a batch: nobody's, on any ground.
struct RecordedRequest {
  Asker asker;
  std::map<std::string, std::string> terrains;  // TerrainSite::version() by name
  std::string_view head;                        // that line with its end; empty: there is none
  std::string_view body;
};

// The line for a request that is asked now, about these terrains.
std::string request_head(const Service& service, const Asker& asker,
                         const std::vector<std::string>& terrains);
RecordedRequest taken_apart(std::string_view recorded);

// Why the request can't be answered on the ground that it was asked about: a terrain is not what it was. An
// answer that was begun on one and ended on another would be of neither.
std::optional<Error> changed_ground(const Service& service, const RecordedRequest& request);

// What `work` makes of the recorded request. Errors: its own; conflict where a terrain is another than when
// this was asked for, or was replaced meanwhile.
template <class Work>
auto on_its_ground(const Service& service, std::string_view recorded, const Work& work)
    -> decltype(work(RecordedRequest{})) {
  const RecordedRequest request = taken_apart(recorded);
  if (auto changed = changed_ground(service, request)) return fail(*std::move(changed));
  auto made = work(request);
  if (auto changed = changed_ground(service, request)) return fail(*std::move(changed));
  return made;
}

}  // namespace slipway::api
