#include "server/cli/inquiry/command_line.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <exception>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "core/fault_words.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/terminal/interruption.h"
#include "server/cli/terminal/printable_output.h"

namespace slipway::server {
namespace {

// CLI11 reads "nan" and "inf" as numbers; here they never are: every option that is a number refuses them.
void refuse_what_is_not_finite(CLI::App& app) {
  const CLI::Validator finite(
      [](std::string& text) -> std::string {
        double number = 0.0;
        return CLI::detail::lexical_cast(text, number) && !std::isfinite(number)
                   ? text + " is not a finite number"
                   : "";
      },
      "");
  for (CLI::Option* const option : app.get_options())
    if (option->get_type_name().find("FLOAT") != std::string::npos) option->check(finite);
  for (CLI::App* const command : app.get_subcommands({})) refuse_what_is_not_finite(*command);
}

// A word that is no subcommand or option of what was begun, in words with what was probably meant; empty:
// none is. Words behind a value stay CLI11's to judge.
std::string unknown_word(const CLI::App& app, int argc, char** argv) {
  const CLI::App* at = &app;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto commands = at->get_subcommands(std::function<bool(const CLI::App*)>{});
    const auto next = std::find_if(commands.begin(), commands.end(),
                                   [&](const CLI::App* command) { return command->get_name() == word; });
    if (next != commands.end()) {
      at = *next;
      continue;
    }
    if (at->get_prefix_command()) return {};
    if (word.size() > 2 && word.starts_with("--")) {
      const std::string name = word.substr(0, word.find('='));
      std::vector<std::string> known;
      for (const CLI::Option* const option : at->get_options())
        for (const std::string& long_name : option->get_lnames()) known.push_back("--" + long_name);
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      const auto meant = nearest(name, known);
      return fmt::format("unknown option {}{}; slipway {} --help lists all", name,
                         meant ? fmt::format(", did you mean {}?", *meant) : std::string(), at->get_name());
    } else if (at == &app && !word.starts_with("-")) {
      std::vector<std::string> names;
      for (const CLI::App* const command : commands) names.push_back(command->get_name());
      return unknown_name("subcommand", word, names);
    }
  }
  return {};
}

// Where the caller closed standard output, a file that is opened next would take its place, and what is
// printed would land in that file. Nothing can be written to what takes the place here.
void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0) static_cast<void>(open("/dev/null", O_RDONLY));
}

}  // namespace

int parse_and_run(CLI::App& app, const std::function<int()>& run, int argc, char** argv) {
  refuse_what_is_not_finite(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const std::string unknown = error.get_exit_code() == 0 ? "" : unknown_word(app, argc, argv);
    if (!unknown.empty()) std::cerr << unknown << "\n";
    const int status = unknown.empty() ? app.exit(error) : 2;
    return status == 0 ? 0 : 2;
  }
  return run();
}

int run_program(int argc, char** argv, int (*command_line)(int argc, char** argv)) {
  // Ctrl-C gives up a question in progress; serve() takes the signals over for itself.
  std::signal(SIGINT, [](int) { interrupt(); });
  occupy_closed_streams();
  // Names out of files and requests end in what is printed: none of them commands the terminal.
  PrintableOutput answers(std::cout);
  PrintableOutput messages(std::cerr);
  try {
    const int status = command_line(argc, argv);
    return output_has_gone_out() ? status : std::max(status, 1);
  } catch (const std::exception& broken) {
    std::cerr << "internal error: " << broken.what() << "\n";
    return 70;
  }
}

}  // namespace slipway::server
