#include "server/cli/drive_answer.h"

#include <optional>
#include <vector>

#include "api/chart/drive_history.h"
#include "api/documents/station_csv.h"
#include "api/files/model_folder.h"
#include "api/json/parse.h"
#include "server/cli/command_parts.h"
#include "server/cli/terminal/terminal_progress.h"

namespace slipway::server {
namespace {

// An answer of ours: whoever prints it has read it already.
api::json::JsonValue read_answer(std::string_view answer) {
  return api::json::parse(answer, {.bytes = answer.size(), .values = answer.size()}).value();
}

}  // namespace

int ask_and_print(const AskOptions& ask, const Pictures& pictures, const Result<std::string>& request,
                  Result<std::string> (Inquiry::*question)(const std::string&, Progress&),
                  Result<std::string> (*table)(std::string_view), ExitStatus (*verdict)(std::string_view)) {
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
  std::optional<Error> unmade;
  const auto add = [&](const std::string& path, Result<std::string> made) {
    if (made)
      files.push_back({path, *std::move(made)});
    else
      unmade = made.error();
  };
  if (!pictures.map.empty()) add(pictures.map, (*service)->map());
  if (!pictures.history.empty()) add(pictures.history, api::draw_drive_history(*answer));
  if (!pictures.report.empty()) add(pictures.report, (*service)->report());
  if (!pictures.csv.empty()) add(pictures.csv, api::json::station_csv(*answer));
  const int status = deliver(files, *printed + (ask.json ? "\n" : ""));
  if (unmade) return refuse(*unmade);
  return status == kDone ? verdict(*answer) : status;
}

ExitStatus check_status(std::string_view check) {
  return status_of(read_answer(check).find("verdict")->text);
}

ExitStatus prediction_status(std::string_view prediction) {
  return status_of(read_answer(prediction).find("decision")->find("verdict")->text);
}

ExitStatus plan_status(std::string_view plan) {
  const api::json::JsonValue document = read_answer(plan);
  const auto& routes = document.find("summary")->elements;
  return routes.empty() ? kNoGo : status_of(routes.front().find("verdict")->text);
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
