#include "api/files/slip_steps_file.h"

#include "api/files/terrain_site.h"
#include "steps/slip_steps_csv.h"

namespace slipway::api {

Result<std::vector<steps::SlipStep>> read_slip_steps_file(const std::filesystem::path& path,
                                                          const std::string& name) {
  const auto bytes = read_data_file(path);
  if (!bytes) return fail(bytes.error());
  return steps::read_slip_steps(*bytes, name);
}

}  // namespace slipway::api
