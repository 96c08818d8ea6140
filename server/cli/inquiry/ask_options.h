#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace slipway::server {

// What the command line was asked, in plain structs: how it was parsed is cli_app's affair.
struct AskOptions {
  std::string data;                 // folder of --data; empty here and below: see data_folder.h
  std::string url;                  // empty: the service in this process
  bool json = false;                // the document instead of a table
  bool why = false;                 // print all that led to a verdict
  std::string model;                // folder of a corrected model, as diagnose writes it; empty: none
  std::vector<std::string> ground;  // soils of terrains that are that model's
};

// --data, --url and --json.
void add_ask(CLI::App& command, AskOptions& ask);
// --data and --json, of commands that this process answers itself.
void add_local_ask(CLI::App& command, AskOptions& ask);
// --why, of commands whose answer is a verdict.
void add_why(CLI::App& command, AskOptions& ask);
// --model and --ground; after add_ask().
void add_model(CLI::App& command, AskOptions& ask);

}  // namespace slipway::server
