#include "server/cli/commands/study_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_folder.h"

namespace slipway::server {
namespace {

int hand_on(const std::string& name, std::vector<std::string> words) {
  const std::filesystem::path study = data_places("").executable.parent_path() / "slipway-study";
  if (std::error_code error; !std::filesystem::exists(study, error))
    return refuse(
        {ErrorCode::kNotFound,
         fmt::format(
             "slipway {} is done by slipway-study, which is not installed: there is no {}. Build it with "
             "cmake -DSLIPWAY_BUILD_RESEARCH=ON and install the component research",
             name, study.string()),
         {}});
  words.insert(words.begin(), {study.string(), name});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(arguments.front(), arguments.data());
  return refuse(
      {ErrorCode::kInternal, fmt::format("{} does not start: {}", study.string(), std::strerror(errno)), {}});
}

}  // namespace

void add_study_commands(CLI::App& app, std::function<int()>& run) {
  for (const auto& [name, summary] :
       {std::pair{
            "gap-benchmark",
            "diagnose a folder of campaigns (made first, if asked for), then score the diagnoses against its "
            "answers.json (slipway-study)"},
        std::pair{"validate",
                  "compare with published and measured data, and say how far off (slipway-study)"},
        std::pair{
            "worlds",
            "plan in made worlds whose truth is known, drive there, and compare planners and predictions "
            "(slipway-study)"}}) {
    CLI::App* const command = app.add_subcommand(name, summary);
    command->set_help_flag();  // slipway-study has it
    command->prefix_command();
    command->callback([command, &run, name = std::string(name)] {
      run = [name, words = command->remaining()] { return hand_on(name, words); };
    });
  }
}

}  // namespace slipway::server
