#include <CLI/CLI.hpp>
#include <functional>
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

constexpr Question kQuestions[] = {{"health", "whether a running service answers", &health},
                                   {"rovers", "what rovers there are", &rovers},
                                   {"soils", "what soils there are, with their sources", &soils}};

void add_effects_command(CLI::App& app, std::function<int()>& run) {
  struct EffectsCommand {
    AskOptions ask;
    std::string name;
  };
  const auto options = std::make_shared<EffectsCommand>();
  CLI::App* command =
      app.add_subcommand("effects", "what effects can be switched on, and what their parameters mean");
  command->add_option("effect", options->name,
                      "an effect whose parameters are explained; all are listed without it");
  add_ask(*command, options->ask);
  command->footer(
      "Example: what effects are there, and what do the parameters of one of them mean?\n"
      "  slipway effects\n"
      "  slipway effects grousers");
  command->callback([options, &run] { run = [options] { return effects(options->ask, options->name); }; });
}

}  // namespace

void add_catalogue_commands(CLI::App& app, std::function<int()>& run) {
  add_effects_command(app, run);
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
