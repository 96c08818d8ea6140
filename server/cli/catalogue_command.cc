#include "server/cli/catalogue_command.h"

#include "server/cli/catalogue_printing.h"
#include "server/cli/command_parts.h"
#include "server/cli/terminal/tables.h"

namespace slipway::server {

int rovers(const AskOptions& options) {
  return print_catalogue(options, "rovers", &rover_table);
}

int soils(const AskOptions& options) {
  return print_catalogue(options, "soils", &soil_table);
}

int effects(const AskOptions& options) {
  return print_catalogue(options, "effects", &effect_table);
}

int health(const AskOptions& options) {
  if (options.url.empty())
    return refuse({ErrorCode::kInvalidRequest,
                   "there is nobody to ask",
                   {{"/url", "must be the address of a running service, http://HOST:PORT"}}});
  const auto service = inquiry(options);
  if (!service) return refuse(service.error());
  const auto document = (*service)->health();
  if (!document) return refuse(document.error());
  return deliver({}, *document + "\n");
}

}  // namespace slipway::server
