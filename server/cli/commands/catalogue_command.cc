#include "server/cli/commands/catalogue_command.h"

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>

#include "api/json/faults.h"
#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "api/json/writer.h"
#include "server/cli/inquiry/catalogue_printing.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/terminal/tables.h"

namespace slipway::server {
namespace {

// The same catalogue with the effect of this name alone. Errors: invalid_request where it has no such effect.
Result<std::string> with_one_effect(std::string_view document, const std::string& name) {
  const auto parsed = api::json::parse(document, {.bytes = document.size(), .values = document.size()});
  if (!parsed) return fail(parsed.error());
  std::vector<std::string> known;
  for (const api::json::JsonValue& effect : api::json::at(*parsed, "effects").elements) {
    known.push_back(api::json::text(effect, "name"));
    if (known.back() != name) continue;
    api::json::Writer w;
    w.begin_object().key("effects").begin_array();
    api::json::write_value(w, effect);
    w.end_array().end_object();
    return w.take();
  }
  const std::string message = unknown_name("effect", name, known);
  return fail(ErrorCode::kInvalidRequest, message, {{"/effect", message}});
}

}  // namespace

int rovers(const AskOptions& options) {
  return print_catalogue(options, "rovers", &rover_table);
}

int soils(const AskOptions& options) {
  return print_catalogue(options, "soils", &soil_table);
}

int effects(const AskOptions& options, const std::string& name) {
  if (name.empty()) return print_catalogue(options, "effects", &effect_table);
  const auto service = inquiry(options);
  if (!service) return refuse(service.error());
  const auto document = (*service)->catalogue("effects");
  if (!document) return refuse(document.error());
  return print_document(options, with_one_effect(*document, name), &effect_field_table);
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
