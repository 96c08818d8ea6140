#pragma once

#include <functional>
#include <string>

#include "research/validation/worlds/world_study.h"

namespace CLI {
class App;
}

namespace slipway::server {

struct WorldsCommand {
  std::string data;
  std::string rover = "mer-class";
  validation::WorldStudyOptions study;
  int threads = 0;
  std::string scores;  // file of scores to count in place of a study; empty: none
  std::string csv;     // file for the scores; empty: none
  std::string plots;   // folder for the charts; empty: none
  std::string check;   // page whose printed part must be what comes out; empty: none
  std::string write;   // page whose printed part is replaced; empty: none
};

// The exit status: 0 done (and the page is as it should be), 1 it is not or the work was interrupted, 2
// options or files with faults.
int worlds(const WorldsCommand& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_worlds_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
