#include "server/cli/inquiry/catalogue_printing.h"

#include "server/cli/inquiry/command_parts.h"

namespace slipway::server {

int print_catalogue(const AskOptions& ask, std::string_view kind,
                    Result<std::string> (*table)(std::string_view)) {
  const auto service = inquiry(ask);
  if (!service) return refuse(service.error());
  return print_document(ask, (*service)->catalogue(kind), table);
}

int print_document(const AskOptions& ask, const Result<std::string>& document,
                   Result<std::string> (*table)(std::string_view)) {
  if (!document) return refuse(document.error());
  const auto printed = ask.json ? document : table(*document);
  if (!printed) return refuse(printed.error());
  return deliver({}, *printed + (ask.json ? "\n" : ""));
}

}  // namespace slipway::server
