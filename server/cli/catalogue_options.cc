#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "server/cli/catalogue_command.h"

namespace slipway::server {
namespace {

struct Question {
  const char* name;
  const char* about;
  int (*answer)(const AskOptions&);
};

constexpr Question kQuestions[] = {
    {"effects", "what effects can be switched on, with their parameters", &effects},
    {"health", "whether a running service answers", &health},
    {"rovers", "what rovers there are", &rovers},
    {"soils", "what soils there are, with their sources", &soils}};

}  // namespace

void add_catalogue_commands(CLI::App& app, std::function<int()>& run) {
  const auto ask = std::make_shared<AskOptions>();
  for (const Question& question : kQuestions) {
    CLI::App* command = app.add_subcommand(question.name, question.about);
    add_ask(*command, *ask);
    const std::string name = question.name;
    command->footer("Example:\n  slipway " + name +
                    (name == "health" ? " --url http://127.0.0.1:8080" : " --json"));
    command->callback(
        [ask, answer = question.answer, &run] { run = [ask, answer] { return answer(*ask); }; });
  }
}

}  // namespace slipway::server
