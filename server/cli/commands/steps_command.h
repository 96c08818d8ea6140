#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace slipway::server {

struct StepsScoreCommand {
  std::string table;  // "slip-steps/1"
  std::string data, rover = "msl-class", terrain, legend, learn = "none", plot;
  bool json = false;
};

// The exit status: 0 compared, 1 not written, 2 options or files with faults.
int steps_score(const StepsScoreCommand& options);

struct StepsLearnCommand {
  std::vector<std::string> tables;
  std::string data, rover = "msl-class", out;
  // "NAME=978,538:20-36" (sols, or steps of a sol counted from 1) or "NAME=unit:SM,SMR".
  std::vector<std::string> classes;
};

// As above; 1 also where it was given up.
int steps_learn(const StepsLearnCommand& options);

void add_steps_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
