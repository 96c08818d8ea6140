#include "server/cli/drive_answer.h"

#include <optional>
#include <vector>

#include "api/chart/drive_history.h"
#include "api/files/model_folder.h"
#include "server/cli/command_parts.h"
#include "server/cli/terminal/terminal_progress.h"

namespace slipway::server {

int ask_and_print(const AskOptions& ask, const Pictures& pictures, const Result<std::string>& request,
                  Result<std::string> (Inquiry::*question)(const std::string&, Progress&),
                  Result<std::string> (*table)(std::string_view)) {
  if (!request) return refuse(request.error());
  const auto service = inquiry(ask);
  if (!service) return refuse(service.error());
  Result<std::string> answer;
  {
    TerminalProgress progress;
    answer = ((**service).*question)(*request, progress);
  }
  if (!answer) return refuse(answer.error());
  const auto printed = ask.json ? answer : table(*answer);
  if (!printed) return refuse(printed.error());
  std::vector<OutputFile> files;
  std::optional<Error> undrawn;
  if (!pictures.map.empty()) {
    auto map = (*service)->map();
    if (!map) undrawn = map.error();
    if (map) files.push_back({pictures.map, *std::move(map)});
  }
  if (!pictures.history.empty()) {
    auto history = api::draw_drive_history(*answer);
    if (!history) undrawn = history.error();
    if (history) files.push_back({pictures.history, *std::move(history)});
  }
  const int status = deliver(files, *printed + (ask.json ? "\n" : ""));
  return undrawn ? refuse(*undrawn) : status;
}

Result<std::string> models_rover(const AskOptions& ask, const std::string& rover, bool any_rover) {
  if (ask.model.empty()) return rover;
  const auto folder = api::load_model_folder(ask.model);
  if (!folder) return fail(folder.error());
  const std::string& corrected = folder->model.rover.name;
  if (rover == folder->nominal_rover || rover == corrected) return corrected;
  if (!any_rover) return fail(api::not_of_this_rover(*folder, rover));
  return rover;
}

}  // namespace slipway::server
