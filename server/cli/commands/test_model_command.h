#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace slipway::server {

struct TestModelCommand {
  std::string data;
  std::string campaign, model;      // folders
  std::vector<std::string> ground;  // the campaign's soils that are the model's
  std::uint64_t seed = 1;
  int threads = 0;  // 0: as many as the machine has
  bool json = false;
};

// The exit status: 0 figures, whatever they are, 1 none, 2 input that can't be read.
int test_model(const TestModelCommand& options);

// Adds the subcommand; `run` then runs it where it is given.
void add_test_model_command(CLI::App& app, std::function<int()>& run);

}  // namespace slipway::server
